// Include next to palpate.hpp to choose a composition before it is built in: a suggested element and mesh, refinement
// to an accuracy, the measured error of contact forces, the Pareto front of measured compositions, natural frequencies.
#pragma once

#include <palpate/model/static/measured_force_error.hpp>
#include <palpate/model/static/natural_frequencies.hpp>
#include <palpate/model/static/refine_to_accuracy.hpp>
#include <palpate/model/static/suggest.hpp>
#include <palpate/model/static/trade_off.hpp>
