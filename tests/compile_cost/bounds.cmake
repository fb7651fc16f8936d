# What compiling may cost at most, without a clock. All bounds are here; a change that needs a higher one says why.
#
# <program>_<mode>_percent    what the preprocessor hands to the compiler, in percent of what it hands over for a sparse
#                             solve with plain Eigen (benchmarks/compile_time/programs/unit.cpp)
# <program>_<mode>_functions  functions of palpate and Eigen that the program compiles for itself (-O0: nothing inlined)
set(readme_compiled_percent 115)
set(readme_header_only_percent 180)
set(readme_compiled_functions 1550)
set(readme_header_only_functions 14000)
set(mesh_only_compiled_percent 115)
set(mesh_only_header_only_percent 180)
set(mesh_only_compiled_functions 140)
