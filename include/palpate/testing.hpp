// Include to check types of your own against the laws that palpate's algorithms rely on: elements, materials, meshes,
// solvers, tissues, devices, executors. The functions return what is violated; they need no test framework.
#pragma once

#include <palpate/testing/assembler_laws.hpp>
#include <palpate/testing/condensation_laws.hpp>
#include <palpate/testing/device_laws.hpp>
#include <palpate/testing/element_laws.hpp>
#include <palpate/testing/executor_laws.hpp>
#include <palpate/testing/hyperelastic_laws.hpp>
#include <palpate/testing/material_laws.hpp>
#include <palpate/testing/mesh_laws.hpp>
#include <palpate/testing/quadrature_laws.hpp>
#include <palpate/testing/same_tissue_laws.hpp>
#include <palpate/testing/solver_laws.hpp>
#include <palpate/testing/stability.hpp>
#include <palpate/testing/tissue_laws.hpp>
