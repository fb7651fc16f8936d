// A fake of the functions of DHD that palpate calls: names and signatures as documented, behaviour written for the
// tests.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace fake_dhd {

struct Sdk {
  std::vector<std::string> calls;
  std::array<double, 3> position{}, velocity{}, force{}, torque{};
  double rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  unsigned buttons = 0;
  double max_force = 0.0;
  int read_answer = 0, velocity_answer = 0, force_answer = 0, open_answer = 4, enable_answer = 0;
  int forces_sent = 0;
  bool enabled = false;
};
inline Sdk*& current() {
  static Sdk* s = nullptr;
  return s;
}
inline Sdk& sdk() {
  return *current();
}
struct Scope {
  Sdk sdk;
  Scope() { current() = &sdk; }
  ~Scope() { current() = nullptr; }
};

}  // namespace fake_dhd

inline int dhdOpen() {
  fake_dhd::sdk().calls.push_back("open");
  return fake_dhd::sdk().open_answer;
}
inline int dhdClose(char id = -1) {
  fake_dhd::sdk().calls.push_back("close " + std::to_string(static_cast<int>(id)));
  return 0;
}
inline int dhdEnableForce(unsigned char on, char = -1) {
  auto& s = fake_dhd::sdk();
  s.calls.push_back(on ? "on" : "off");
  if (s.enable_answer < 0) return s.enable_answer;
  s.enabled = on != 0;
  if (!s.enabled) s.force = s.torque = {};
  return 0;
}
inline int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double r[3][3], char = -1) {
  auto& s = fake_dhd::sdk();
  *x = s.position[0];
  *y = s.position[1];
  *z = s.position[2];
  for (int i = 0; i < 3; ++i) std::copy_n(s.rotation[i], 3, r[i]);
  return s.read_answer;
}
inline int dhdGetLinearVelocity(double* x, double* y, double* z, char = -1) {
  auto& s = fake_dhd::sdk();
  *x = s.velocity[0];
  *y = s.velocity[1];
  *z = s.velocity[2];
  return s.velocity_answer;
}
inline unsigned int dhdGetButtonMask(char = -1) {
  return fake_dhd::sdk().buttons;
}
inline int dhdSetForceAndTorque(double x, double y, double z, double a, double b, double c, char = -1) {
  auto& s = fake_dhd::sdk();
  ++s.forces_sent;
  if (s.enabled && s.force_answer >= 0) {
    s.force = {x, y, z};
    s.torque = {a, b, c};
  }
  return s.force_answer;
}
inline int dhdSetForce(double x, double y, double z, char id = -1) {
  return dhdSetForceAndTorque(x, y, z, 0.0, 0.0, 0.0, id);
}
inline int dhdSetMaxForce(double newtons, char = -1) {
  fake_dhd::sdk().max_force = newtons;
  return 0;
}
inline const char* dhdErrorGetLastStr() {
  return "no device found";
}
