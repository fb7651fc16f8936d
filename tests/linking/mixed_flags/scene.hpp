// A palpate type that crosses translation units in both directions: as a result and as a parameter.
#pragma once

#include <palpate/mesh/scene.hpp>

palpate::Scene make_scene();
void add_gravity(palpate::Scene& scene);
