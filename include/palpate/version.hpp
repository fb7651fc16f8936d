#pragma once

/// The version of palpate. CMake reads it from this file; it is defined nowhere else.
#define PALPATE_VERSION_MAJOR 0
#define PALPATE_VERSION_MINOR 1
#define PALPATE_VERSION_PATCH 0

/// One number for comparisons: 0.1.0 is 100, 1.2.3 is 10203.
#define PALPATE_VERSION (PALPATE_VERSION_MAJOR * 10000 + PALPATE_VERSION_MINOR * 100 + PALPATE_VERSION_PATCH)
