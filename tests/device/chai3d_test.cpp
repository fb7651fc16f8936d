// The CHAI3D adapter against a fake device with the same functions.
#include <palpate/device/chai3d.hpp>
#include <palpate/testing/device_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using palpate::testing::gated;

namespace {

class FakeVector {
 public:
  FakeVector() = default;
  FakeVector(const double& x, const double& y, const double& z) : v_{x, y, z} {}
  double x() const { return v_[0]; }
  double y() const { return v_[1]; }
  double z() const { return v_[2]; }

 private:
  std::array<double, 3> v_{};
};
struct FakeMatrix {
  std::array<std::array<double, 3>, 3> m{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const double& operator()(unsigned i, unsigned j) const { return m[i][j]; }
};
struct FakeInfo {
  double m_maxLinearForce = 8.0, m_maxLinearStiffness = 3000.0, m_workspaceRadius = 0.04;
  double m_maxAngularTorque = 0.1, m_maxAngularStiffness = 1.5;
};
struct FakeDevice {
  FakeInfo info;
  FakeVector position, velocity, force, torque;
  FakeMatrix rotation;
  unsigned buttons = 0;
  bool opens = true, reads = true, gives_velocity = true, takes_force = true, is_open = false;

  bool open() { return is_open = opens; }
  bool close() {
    is_open = false;
    return true;
  }
  FakeInfo getSpecifications() { return info; }
  bool getPosition(FakeVector& v) {
    v = position;
    return reads;
  }
  bool getLinearVelocity(FakeVector& v) {
    v = velocity;
    return gives_velocity;
  }
  bool getRotation(FakeMatrix& r) {
    r = rotation;
    return true;
  }
  bool getUserSwitches(unsigned int& b) {
    b = buttons;
    return true;
  }
  bool setForce(const FakeVector& f) {
    if (takes_force) force = f;
    return takes_force;
  }
  bool setForceAndTorque(const FakeVector& f, const FakeVector& t) {
    torque = t;
    return setForce(f);
  }
};
using Stylus = Chai3dDevice<FakeDevice, FakeVector, FakeMatrix>;
static_assert(HapticDevice<Stylus>);

Vector3 chai_vector(const FakeVector& v) {
  return Vector3(v.x(), v.y(), v.z());
}
Vector3 chai_force(const FakeDevice& d) {
  return chai_vector(d.force);
}

template <class F>
SetupErrorKind chai_refusal(F f) {
  try {
    f();
  } catch (const SetupError& error) {
    return error.kind();
  }
  return SetupErrorKind::cancelled;
}

}  // namespace

TEST_CASE("chai3d: states and limits", "[device][chai3d]") {
  FakeDevice fake;
  fake.position = FakeVector(0.01, -0.02, 0.03);
  fake.velocity = FakeVector(0.1, 0.2, -0.3);
  fake.rotation.m = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
  fake.buttons = 2;
  Stylus stylus(fake);
  CHECK(fake.is_open);
  const ToolState s = stylus.read();
  CHECK(s.valid);
  CHECK(s.position == Vector3(0.01, -0.02, 0.03));
  CHECK(s.velocity == Vector3(0.1, 0.2, -0.3));
  CHECK_THAT(s.orientation[3], WithinAbs(std::sqrt(0.5), 1e-12));
  CHECK(s.buttons == 2);
  CHECK(stylus.limits().peak_force == 8.0);
  CHECK(stylus.limits().continuous_force == 2.0);
  CHECK(stylus.limits().stiffness == 3000.0);
  CHECK(stylus.limits().workspace_high == Vector3::Constant(0.04));
  CHECK(stylus.limits().peak_torque == 0.0);  // without the option
}

TEST_CASE("chai3d: satisfies the laws of devices", "[device][chai3d][laws]") {
  for (const bool torque : {false, true}) {
    FakeDevice fake;
    Chai3dOptions options;
    options.torque = torque;
    Stylus stylus(fake, options);
    testing::DeviceProbe<Stylus> probe;
    probe.rendered = [&](const Stylus&) { return chai_force(fake); };
    probe.rendered_torque = [&](const Stylus&) { return chai_vector(fake.torque); };
    probe.break_reads = [&](Stylus&, bool broken) { fake.reads = !broken; };
    CHECK(testing::describe(testing::device_laws(stylus, probe, 1000)) == "");
  }
}

TEST_CASE("chai3d: failures set the force to zero", "[device][chai3d][extreme][D6]") {
  FakeDevice fake;
  {
    Stylus stylus(fake);
    const Vector3 force(0.0, 1.0, 0.0);
    stylus.read();
    stylus.write(gated(force));
    CHECK(chai_force(fake) == Vector3::Zero());  // not started
    stylus.start();
    CHECK(stylus.write(gated(force)).ok());
    CHECK(chai_force(fake) == force);
    fake.takes_force = false;
    CHECK(stylus.write(gated(force)) == Status(StatusFlag::disconnected));
    CHECK(stylus.last_force() == Vector3::Zero());
    fake.takes_force = true;
    CHECK(stylus.write(gated(force)).has(StatusFlag::disconnected));  // until a read is valid again
    CHECK(chai_force(fake) == Vector3::Zero());
    fake.gives_velocity = false;
    CHECK(std::isnan(stylus.read().velocity[0]));
    fake.position = FakeVector(0.0, infinity, 0.0);
    CHECK(!stylus.read().valid);
    CHECK(stylus.write(gated(force)).has(StatusFlag::disconnected));
    fake.position = FakeVector();
    CHECK(stylus.read().valid);
    CHECK(stylus.write(gated(force)).ok());
  }
  CHECK(chai_force(fake) == Vector3::Zero());
  CHECK(!fake.is_open);
}

TEST_CASE("chai3d: torque for devices with torque motors", "[device][chai3d]") {
  FakeDevice fake;
  Chai3dOptions options;
  options.torque = true;
  Stylus stylus(fake, options);
  stylus.start();
  stylus.read();
  stylus.write(gated(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 0.02, 0.0)));
  CHECK(fake.torque.y() == 0.02);
  CHECK(stylus.limits().peak_torque == 0.1);
  CHECK(stylus.limits().rotational_stiffness == 1.5);
  CHECK(stylus.write(gated(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 3.0, 0.0))) == Status(StatusFlag::saturated));
  CHECK_THAT(fake.torque.y(), WithinAbs(0.1, 1e-15));
  stylus.write(gated(Vector3(1.0, 0.0, 0.0), Vector3(0.0, infinity, 0.0)));
  CHECK(fake.torque.y() == 0.0);
  CHECK(chai_force(fake) == Vector3::Zero());
}

TEST_CASE("chai3d: torque without torque limits is refused, torque limits without torque are ignored",
          "[device][chai3d]") {
  FakeDevice fake;
  Chai3dOptions options;
  options.torque = true;
  for (double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), infinity}) {
    fake.info.m_maxAngularTorque = bad;
    CHECK(chai_refusal([&] { Stylus stylus(fake, options); }) == SetupErrorKind::bad_argument);
    fake.info.m_maxAngularTorque = 0.1;
    fake.info.m_maxAngularStiffness = bad;
    CHECK(chai_refusal([&] { Stylus stylus(fake, options); }) == SetupErrorKind::bad_argument);
    fake.info.m_maxAngularStiffness = 1.0;
  }
  options.limits = DeviceLimits{};
  CHECK(chai_refusal([&] { Stylus stylus(fake, options); }) == SetupErrorKind::bad_argument);
  CHECK(!fake.is_open);
  options.torque = false;
  options.limits->peak_torque = options.limits->rotational_stiffness = 0.1;
  CHECK(Stylus(fake, options).limits().peak_torque == 0.0);
}

TEST_CASE("chai3d: no device, or one without a specification, is refused", "[device][chai3d]") {
  FakeDevice fake;
  fake.opens = false;
  CHECK(chai_refusal([&] { Stylus stylus(fake); }) == SetupErrorKind::unsupported);
  fake.opens = true;
  fake.info.m_maxLinearStiffness = 0.0;
  CHECK(chai_refusal([&] { Stylus stylus(fake); }) == SetupErrorKind::bad_argument);
  CHECK(!fake.is_open);
  Chai3dOptions options;
  options.limits = DeviceLimits{};
  CHECK(Stylus(fake, options).limits().peak_force == 3.3);
}
