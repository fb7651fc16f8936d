// Large strain and motion, in addition to palpate.hpp: materials, statics, implicit and explicit dynamics, and tissue
// that moves while it is touched.
#pragma once

#include <palpate/haptic/background_worker.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/fibre_reinforced.hpp>
#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/material/viscoelastic.hpp>
#include <palpate/model/moving/explicit.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/model/moving/renewed_factor.hpp>
#include <palpate/model/static/stiffening.hpp>
