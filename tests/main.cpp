// The main program of every test executable with Catch2 v2; v3 provides its own.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
