// Shared by both sources of this program.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <memory>

using Tissue =
    palpate::HapticFEModel<palpate::Tet4, palpate::LinearElastic, palpate::Condensed<palpate::SelectiveInverse>>;

std::unique_ptr<Tissue> make_tissue();
