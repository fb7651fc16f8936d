// What games and many simulators take: springs, and constraints on positions. Both move nodes out of the balls, and the
// force is what that takes.
#include <palpate/assembly/constant_geometry.hpp>
#include <palpate/assembly/mass_matrix.hpp>
#include <palpate/material/linear_elastic.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <map>

#include "contender.hpp"
#include "free_motion.hpp"

namespace tradeoff {
namespace {

/// Nodes with mass that are held, or kept out of balls.
struct Particles {
  std::vector<Vector3> rest, place, before, velocity, force;
  std::vector<double> inverse_mass;
  std::vector<NodeId> touchable;
  double radius = 0.0;

  explicit Particles(const Bench& bench)
      : rest(bench.scene.mesh.positions),
        place(rest),
        before(rest),
        velocity(rest.size(), Vector3::Zero()),
        force(velocity),
        touchable(bench.scene.mesh.find_group(near_group)->nodes),
        radius(bench.scene.radius) {
    const VectorX mass = lumped_mass(make_body(bench.scene.mesh, bench.scene.materials));
    for (const double m : mass) inverse_mass.push_back(1.0 / m);
    for (const NodeId node : bench.scene.mesh.find_group(held_group)->nodes)
      inverse_mass[static_cast<std::size_t>(node)] = 0.0;
  }
  /// Moves nodes out of the balls; adds what that takes in a step of dt to the forces on the balls.
  void leave(std::span<const Vector3> centres, double dt, std::vector<Vector3>& forces) {
    for (const NodeId node : touchable)
      for (std::size_t b = 0; b < centres.size(); ++b) {
        const auto i = static_cast<std::size_t>(node);
        const Vector3 off = place[i] - centres[b];
        const double depth = radius - off.norm();
        if (!(depth > 0.0) || inverse_mass[i] == 0.0) continue;
        const Vector3 way = depth * off.normalized();
        place[i] += way;
        forces[b] -= way / (inverse_mass[i] * dt * dt);
      }
  }
  void coast(double dt) {
    const double kept = std::max(0.0, 1.0 - drag_ * dt);
    for (std::size_t i = 0; i < place.size(); ++i) {
      before[i] = place[i];
      if (inverse_mass[i] == 0.0) continue;
      velocity[i] = kept * velocity[i] + dt * inverse_mass[i] * force[i];
      place[i] += dt * velocity[i];
    }
  }
  void find_velocity(double dt) {
    for (std::size_t i = 0; i < place.size(); ++i) velocity[i] = (place[i] - before[i]) / dt;
  }
  double kinetic_energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i)
      if (inverse_mass[i] > 0.0) sum += 0.5 / inverse_mass[i] * velocity[i].squaredNorm();
    return sum;
  }
  VectorX displacement() const {
    VectorX u(3 * static_cast<Index>(place.size()));
    for (std::size_t i = 0; i < place.size(); ++i) u.segment<3>(3 * static_cast<Index>(i)) = place[i] - rest[i];
    return u;
  }
  double drag_ = drag;
};

/// The rest of a contender whose `Body` has particles, step(dt, centres, forces), energy() and held_force().
template <class Body>
class ParticleContender : public Contender {
 public:
  ParticleContender(const Bench& bench, Body body, int steps)
      : bench_(bench), body_(std::move(body)), steps_(steps), forces_(bench.scene.balls.size()), now_(forces_) {}

  /// The balls go evenly through a tick: a jump in its first step would be a blow, the harder the shorter the step.
  std::span<const Vector3> tick(std::span<const Vector3> centres) override {
    if (before_.empty()) before_.assign(centres.begin(), centres.end());
    std::ranges::fill(forces_, Vector3::Zero());
    for (int s = 1; s <= steps_; ++s) {
      for (std::size_t b = 0; b < now_.size(); ++b)
        now_[b] = before_[b] + static_cast<double>(s) / steps_ * (centres[b] - before_[b]);
      body_.step(1e-3 / steps_, now_, forces_);
    }
    before_.assign(centres.begin(), centres.end());
    for (Vector3& f : forces_) f /= steps_;
    return forces_;
  }
  VectorX displacement() override { return body_.particles.displacement(); }
  /// How far the forces on held nodes are from what the balls push.
  double own_error() override {
    Vector3 sum = body_.held_force();
    double size = 0.0;
    for (const Vector3& f : forces_) {
      sum -= f;
      size += f.norm();
    }
    return sum.norm() / size;
  }
  double energy_drift() override {
    Body free = body_;
    free.particles.drag_ = 0.0;
    std::ranges::fill(free.particles.velocity, Vector3::Zero());
    const double before = free.energy();
    std::vector<Vector3> none;
    for (double t = 0.0; t < free_swing - 1e-9; t += 1e-3 / steps_) free.step(1e-3 / steps_, {}, none);
    return (free.energy() + free.particles.kinetic_energy()) / before - 1.0;
  }
  Index nodes() const override { return bench_.scene.mesh.node_count(); }
  std::string remark() override { return std::to_string(steps_) + " steps per tick"; }

 private:
  const Bench& bench_;
  Body body_;
  int steps_;
  std::vector<Vector3> forces_, now_, before_;  // of the balls; where they are in a step, where they were last
};

/// A spring along every edge, E sum of volumes round it / length^2 stiff (Van Gelder, Approximate simulation of elastic
/// membranes by triangulated spring meshes, 1998, in its form for tetrahedra). Semi-implicit Euler.
struct MassSpring {
  struct Spring {
    NodeId a, b;
    double length, stiffness;
  };
  Particles particles;
  std::vector<Spring> springs;

  explicit MassSpring(const Bench& bench, double factor = 1.0) : particles(bench) {
    const Mesh<Tet4>& mesh = bench.scene.mesh;
    const auto laws = materials_by_region(mesh, bench.scene.materials);
    std::map<std::pair<NodeId, NodeId>, double> stiffness;
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const double volume = constant_geometry<Tet4>(mesh, e).volume,
                   modulus = laws[static_cast<std::size_t>(mesh.region(e))].youngs_modulus;
      for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j)
          stiffness[std::minmax(mesh.element_node(e, i), mesh.element_node(e, j))] += modulus * volume;
    }
    for (const auto& [edge, sum] : stiffness) {
      const double length = (mesh.position(edge.first) - mesh.position(edge.second)).norm();
      springs.push_back({edge.first, edge.second, length, factor * sum / (length * length)});
    }
  }
  /// Steps that a millisecond needs: Gershgorin's bound of the highest frequency.
  int steps() const {
    std::vector<double> sum(particles.rest.size(), 0.0);
    for (const Spring& s : springs)
      for (const NodeId i : {s.a, s.b}) sum[static_cast<std::size_t>(i)] += 2.0 * s.stiffness;
    double square = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) square = std::max(square, sum[i] * particles.inverse_mass[i]);
    return static_cast<int>(std::ceil(1e-3 * std::sqrt(square) / 2.0 / 0.8));
  }
  void pull() {
    std::ranges::fill(particles.force, Vector3::Zero());
    for (const Spring& s : springs) {
      const auto a = static_cast<std::size_t>(s.a), b = static_cast<std::size_t>(s.b);
      const Vector3 way = particles.place[b] - particles.place[a];
      const double length = way.norm();
      const Vector3 f = s.stiffness * (1.0 - s.length / length) * way;
      particles.force[a] += f;
      particles.force[b] -= f;
    }
  }
  void step(double dt, std::span<const Vector3> centres, std::vector<Vector3>& forces) {
    pull();
    particles.coast(dt);
    particles.leave(centres, dt, forces);
    particles.find_velocity(dt);
  }
  double energy() const {
    double sum = 0.0;
    for (const Spring& s : springs) {
      const double longer =
          (particles.place[static_cast<std::size_t>(s.b)] - particles.place[static_cast<std::size_t>(s.a)]).norm() -
          s.length;
      sum += 0.5 * s.stiffness * longer * longer;
    }
    return sum;
  }
  Vector3 held_force() {
    pull();
    Vector3 sum = Vector3::Zero();
    for (std::size_t i = 0; i < particles.force.size(); ++i)
      if (particles.inverse_mass[i] == 0.0) sum -= particles.force[i];
    return sum;
  }
};

/// XPBD (Macklin, Mueller and Chentanez 2016) in small steps of one sweep each (Macklin et al. 2019), with the two
/// constraints of stable neo-Hookean tetrahedra (Macklin and Mueller 2021), an element at a time: sqrt(tr F^T F),
/// compliance 1/(mu V), and det F - 1 - mu/lambda, compliance 1/(lambda V); lambda is Lame's plus mu, so that E and nu
/// are those at small strain.
struct PositionBased {
  struct Element {
    std::array<std::size_t, 4> nodes;
    Eigen::Matrix<double, 4, 3> gradient;
    double volume, mu, lambda;
  };
  Particles particles;
  std::vector<Element> elements;

  explicit PositionBased(const Bench& bench) : particles(bench) {
    const Mesh<Tet4>& mesh = bench.scene.mesh;
    const auto laws = materials_by_region(mesh, bench.scene.materials);
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const auto g = constant_geometry<Tet4>(mesh, e);
      const LinearElastic& law = laws[static_cast<std::size_t>(mesh.region(e))];
      Element element{{}, g.gradient, g.volume, law.shear_modulus(), law.lame_lambda() + law.shear_modulus()};
      for (int a = 0; a < 4; ++a)
        element.nodes[static_cast<std::size_t>(a)] = static_cast<std::size_t>(mesh.element_node(e, a));
      elements.push_back(element);
    }
  }
  Matrix3 deformation(const Element& e) const {
    Matrix3 f = Matrix3::Zero();
    for (int a = 0; a < 4; ++a) f += particles.place[e.nodes[static_cast<std::size_t>(a)]] * e.gradient.row(a);
    return f;
  }
  static Matrix3 cofactor(const Matrix3& f) {
    Matrix3 c;
    c.col(0) = f.col(1).cross(f.col(2));
    c.col(1) = f.col(2).cross(f.col(0));
    c.col(2) = f.col(0).cross(f.col(1));
    return c;
  }
  /// Both constraints at once: one after the other they would push an element at rest to and fro.
  void solve(const Element& e, double dt) {
    const Matrix3 f = deformation(e), c = cofactor(f);
    const double length = f.norm(), volume = f.col(0).dot(c.col(0));
    const Eigen::Matrix<double, 3, 4> shape = f / length * e.gradient.transpose(), size = c * e.gradient.transpose();
    Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
    a.diagonal() << 1.0 / (e.mu * e.volume * dt * dt), 1.0 / (e.lambda * e.volume * dt * dt);
    for (int k = 0; k < 4; ++k) {
      const double w = particles.inverse_mass[e.nodes[static_cast<std::size_t>(k)]];
      a(0, 0) += w * shape.col(k).squaredNorm();
      a(1, 1) += w * size.col(k).squaredNorm();
      a(0, 1) += w * shape.col(k).dot(size.col(k));
    }
    a(1, 0) = a(0, 1);
    const Vector2 multiplier = -a.inverse() * Vector2(length, volume - 1.0 - e.mu / e.lambda);
    for (int k = 0; k < 4; ++k) {
      const std::size_t i = e.nodes[static_cast<std::size_t>(k)];
      particles.place[i] += particles.inverse_mass[i] * (multiplier[0] * shape.col(k) + multiplier[1] * size.col(k));
    }
  }
  void step(double dt, std::span<const Vector3> centres, std::vector<Vector3>& forces) {
    particles.coast(dt);
    for (const Element& e : elements) solve(e, dt);
    particles.leave(centres, dt, forces);
    particles.find_velocity(dt);
  }
  /// mu/2 tr F^T F + lambda/2 (J - 1 - mu/lambda)^2, less that of rest.
  double energy() const {
    double sum = 0.0;
    for (const Element& e : elements) {
      const Matrix3 f = deformation(e);
      const double j = f.determinant() - 1.0 - e.mu / e.lambda, rest = e.mu / e.lambda;
      sum += e.volume * (0.5 * e.mu * (f.squaredNorm() - 3.0) + 0.5 * e.lambda * (j * j - rest * rest));
    }
    return sum;
  }
  /// By the derivative of the energy, which the multipliers meet where a step has converged.
  Vector3 held_force() const {
    Vector3 sum = Vector3::Zero();
    for (const Element& e : elements) {
      const Matrix3 f = deformation(e), c = cofactor(f);
      const Matrix3 stress = e.mu * f + e.lambda * (f.col(0).dot(c.col(0)) - 1.0 - e.mu / e.lambda) * c;
      for (int a = 0; a < 4; ++a)
        if (particles.inverse_mass[e.nodes[static_cast<std::size_t>(a)]] == 0.0)
          sum += e.volume * stress * e.gradient.row(a).transpose();
    }
    return sum;
  }
};

Entry particle_entry(const std::string& element, const std::string& kinematics, const std::string& solver) {
  Entry entry;
  Description& d = entry.description;
  d.family = "baseline";
  d.element = element;
  d.mesh = "as given";
  d.kinematics = kinematics;
  d.solver = solver;
  d.scalar = "double";
  d.allowed = 0.05;
  return entry;
}

}  // namespace

void add_particles(const Bench& bench, std::vector<Entry>& entries) {
  Entry springs = particle_entry("mass-spring", "Van Gelder's stiffness", "semi-implicit Euler");
  springs.make = [&bench] {
    MassSpring body(bench);
    const int steps = body.steps();
    return std::make_unique<ParticleContender<MassSpring>>(bench, std::move(body), steps);
  };
  entries.push_back(springs);
  // Tuned by hand, at its best: on the force at the small depth of this very scene.
  springs.description.kinematics = "stiffness tuned at the small depth";
  springs.make = [&bench] {
    const PressScene& scene = bench.scene;
    double factor = 1.0;
    for (int round = 0; round < 3; ++round) {  // forces of springs are not quite proportional to the factor
      MassSpring body(bench, factor);
      const int steps = body.steps();
      ParticleContender<MassSpring> trial(bench, std::move(body), steps);
      double force = 0.0;
      for (int i = 0; i < 600; ++i)
        force = trial.tick(scene.centres(std::min(1.0, i / 100.0) * scene.small)).front().norm();
      const double wanted = bench.reference.force(0, scene.small).norm();
      if (!(force > 0.01 * wanted))
        raise(SetupErrorKind::not_converged, "springs cannot be tuned: the ball at the small depth meets no node");
      factor *= wanted / force;
    }
    MassSpring body(bench, factor);
    const int steps = body.steps();
    return std::make_unique<ParticleContender<MassSpring>>(bench, std::move(body), steps);
  };
  entries.push_back(springs);
  for (const int steps : {1, 5, 20}) {
    Entry entry = particle_entry("XPBD", "neo-Hookean constraints", std::to_string(steps) + " substeps of one sweep");
    entry.make = [&bench, steps] {
      return std::make_unique<ParticleContender<PositionBased>>(bench, PositionBased(bench), steps);
    };
    entries.push_back(entry);
  }
}

}  // namespace tradeoff
