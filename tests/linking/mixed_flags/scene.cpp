#include "scene.hpp"

palpate::Scene make_scene() {
  return palpate::Scene{}.fix("table");
}
void add_gravity(palpate::Scene& scene) {
  scene.gravity({0.0, 0.0, -9.81});
}
