// What the C++ blocks of the pages take for granted: the includes of palpate, and objects that a reader has by then.
// Compiled only, never linked: nothing is defined. A block's own context is in a comment before it.
#pragma once

#include "device/fakes/dhdc.hpp"
#include "device/fakes/hd.hpp"

#include <palpate/cut.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/organs.hpp>
#include <palpate/palpate.hpp>
#include <palpate/soft.hpp>
#include <palpate/tools.hpp>

#include <palpate/core/executor.hpp>
#include <palpate/device/chai3d.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/device/simulated_device.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/model/moving/detail/corotated_motion.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/model/moving/implicit_dynamics.hpp>
#include <palpate/model/static/trade_off.hpp>
#include <palpate/post/error_estimate.hpp>

#include <iostream>

// As much of CHAI3D and of TBB as the pages use.
namespace chai3d {
struct cVector3d {
  double v[3]{};
  cVector3d() = default;
  cVector3d(double x, double y, double z) : v{x, y, z} {}
  double x() const { return v[0]; }
  double y() const { return v[1]; }
  double z() const { return v[2]; }
};
struct cMatrix3d {
  double m[3][3]{};
  const double& operator()(unsigned i, unsigned j) const { return m[i][j]; }
};
struct cGenericHapticDevice {
  struct Specifications {
    double m_maxLinearForce = 8.0, m_maxLinearStiffness = 3000.0, m_workspaceRadius = 0.04;
    double m_maxAngularTorque = 0.1, m_maxAngularStiffness = 1.5;
  };
  bool open();
  bool close();
  Specifications getSpecifications();
  bool getPosition(cVector3d&);
  bool getLinearVelocity(cVector3d&);
  bool getRotation(cMatrix3d&);
  bool getUserSwitches(unsigned&);
  bool setForce(const cVector3d&);
  bool setForceAndTorque(const cVector3d&, const cVector3d&);
};
}  // namespace chai3d
namespace tbb {
struct simple_partitioner {};
namespace this_task_arena {
int max_concurrency();
}
template <class F>
void parallel_for(int first, int last, const F& f, simple_partitioner) {
  for (int i = first; i < last; ++i) f(i);
}
}  // namespace tbb

namespace page {
using namespace palpate;

using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
extern Mesh<Tet4> mesh;
extern Scene scene;
extern LinearElastic material;
extern Organ organ;
extern SimulatedDevice device, stylus, left, right;
extern HapticServo servo;
extern HapticSession session;
}  // namespace page
