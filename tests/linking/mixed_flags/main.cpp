#include "scene.hpp"

int main() {
  palpate::Scene scene = make_scene();
  add_gravity(scene);
  return scene.gravity()[2] == -9.81 ? 0 : 1;
}
