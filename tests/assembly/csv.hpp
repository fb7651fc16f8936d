#pragma once

#include "number_rows.hpp"

namespace test {

inline const std::string two_cubes_folder = PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/";

}  // namespace test
