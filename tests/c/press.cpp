// The press of press.c with the C++ composition itself: the same output.
#include <palpate/core/platform.hpp>
#include <palpate/io.hpp>
#include <palpate/palpate.hpp>

#include <cstdio>
#include <cstring>
#include <ctime>

using namespace palpate;

namespace {

ToolState place(int i, double time) {
  ToolState state;
  state.position = {-127.0 / 4096, (-147.0 * 1024 + 16.0 * i) / (4096.0 * 1024),
                    (246.0 * 1024 - 90.0 * i) / (4096.0 * 1024)};
  state.time = state.now = time;
  return state;
}

std::uint64_t add_to_hash(std::uint64_t hash, const Vector3& v) {
  std::array<unsigned char, 24> bytes;
  std::memcpy(bytes.data(), v.data(), bytes.size());
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  return hash;
}

double time_ticks(HapticServo& servo, int i, int& tick) {
  constexpr int ticks = 100000;
  const std::clock_t start = std::clock();
  for (int k = 0; k < ticks; ++k) servo.tick(place(i, 1e-3 * tick++));
  return 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / ticks;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return 2;
  const auto mesh = io::read_mesh<Tet4>(arguments[1]);
  Scene scene;
  scene.fix("ligament").touch("front");
  using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
  Organ organ(mesh, scene, {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0});
  HapticServo servo(organ, SphereTool{.radius = 4e-3});

  const FlushDenormals flush;
  std::uint64_t hash = 14695981039346656037u;
  Vector3 last;
  int tick = 0;
  for (; tick < 1024; ++tick) {
    const Vector3 force = servo.tick(place(tick, 1e-3 * tick)).force();
    last = servo.tick_view().contact_force();
    hash = add_to_hash(add_to_hash(hash, force), last);
  }
  const double pressed_us = time_ticks(servo, 1024, tick), free_us = time_ticks(servo, 0, tick);
  std::printf("hash %016llx\nforce", static_cast<unsigned long long>(hash));
  for (const double f : last) {
    std::uint64_t bits;
    std::memcpy(&bits, &f, sizeof bits);
    std::printf(" %016llx", static_cast<unsigned long long>(bits));
  }
  std::printf("\nfree_us %.3f\npressed_us %.3f\n", free_us, pressed_us);
}
