// A palpate type on both ways across the border of a source: as a result and as a parameter.
#pragma once

#include <palpate/mesh/scene.hpp>

palpate::Scene make_scene();
void add_gravity(palpate::Scene& scene);
