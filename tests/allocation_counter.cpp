// The one file of this program that replaces malloc by a counting version.
#define PALPATE_COUNT_ALLOCATIONS
#include <palpate/testing/allocation_counter.hpp>
