// Relaxation, creep and motion of one load case with elements E, compared with a reference table.
#pragma once

#include <palpate/mesh/admission.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/model/moving/implicit_dynamics.hpp>

#include "solve.hpp"

#include <chrono>
#include <numbers>
#include <sstream>

namespace solve_case {

/// The computed values at every row of the table, and the largest difference from the table, relative to the largest
/// number of each column.
struct Course {
  std::string header;
  std::vector<std::vector<double>> rows;
  double error = 0.0;
  double seconds = 0.0;
};

/// A table of numbers with named columns.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;

  explicit Table(const std::string& path) {
    std::istringstream file(palpate::io::read_file(path));
    for (std::string line; std::getline(file, line);) {
      if (line.ends_with('\r')) line.pop_back();
      std::vector<std::string> words;
      std::istringstream in(line);
      for (std::string word; std::getline(in, word, ',');) words.push_back(word);
      if (names.empty())
        names = words;
      else
        rows.push_back(numbers(words, path));
    }
  }
  std::size_t column(const std::string& name) const {
    const auto at = std::ranges::find(names, name);
    if (at == names.end()) palpate::raise(SetupErrorKind::bad_file, "the table has no column '" + name + "'");
    return static_cast<std::size_t>(at - names.begin());
  }

 private:
  std::vector<double> numbers(const std::vector<std::string>& words, const std::string& path) const {
    std::vector<double> row(words.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < words.size(); ++k)
      if (words[k] != "nan" && palpate::io::parse_decimal(words[k], row[k]) != std::errc{})
        palpate::raise(SetupErrorKind::bad_file, path + ": '" + words[k] + "' is not a number");
    if (row.size() != names.size())
      palpate::raise(SetupErrorKind::bad_file, path + ": a row and the first line have different numbers of columns");
    return row;
  }
};

inline constexpr double largest_error = 1e-3;

/// Compares columns of a course, from the second on, with those of a table, row by row. Throws not_converged when the
/// difference is too large: a wrong result is not printed.
inline void compare(Course& course, const Table& table, const std::vector<std::string>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::size_t c = table.column(columns[k]);
    double largest = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < course.rows.size(); ++i) {
      largest = std::max(largest, std::abs(table.rows[i][c]));
      const double difference = std::abs(course.rows[i][k + 1] - table.rows[i][c]);
      worst = std::isfinite(difference) ? std::max(worst, difference) : palpate::infinity;
    }
    course.error = std::max(course.error, worst / largest);
  }
  if (!(course.error <= largest_error))
    palpate::raise(SetupErrorKind::not_converged, "the computed history differs from the table by " +
                                                      palpate::number(course.error) + " of its largest number");
}

/// The unit cube of such a case and its constraints.
template <palpate::Element E>
class CubeInTime {
 public:
  CubeInTime(const palpate::Mesh<E>& mesh, const json& load_case)
      : mesh_(palpate::admit<E>(mesh).mesh), hold_(load_case.at("hold").template get<std::string>()) {
    const json& m = load_case.at("material");
    const auto law = load_case.at("law").template get<std::string>();
    if (law != "all_moduli" && law != "shear_only")
      palpate::raise(SetupErrorKind::unsupported, "the material law '" + law + "'");
    material_ = {{.youngs_modulus = m.at("E0").template get<double>(),
                  .poisson_ratio = m.at("nu0").template get<double>(),
                  .density = 0.0},
                 {{{m.at("g").template get<double>(), m.at("tau").template get<double>()}}},
                 law == "shear_only" ? palpate::Relaxation::deviatoric : palpate::Relaxation::whole_stress};
    body_.emplace(palpate::make_constrained_body(palpate::make_body(mesh_, material_), scene()));
    full_ = body_->conditions().prescribed;
  }

  double tau() const { return material_.terms[0].relaxation_time; }
  bool shears() const { return hold_ == "shear" || hold_ == "ramp_shear" || hold_ == "harmonic"; }
  /// Advances time by dt; the strain at the end is `share` of the full strain.
  void step(double dt, double share) {
    body_->set_prescribed(share * full_);
    const auto report = body_->step(dt);
    if (!report.converged) palpate::raise(SetupErrorKind::not_converged, palpate::describe(report));
  }
  /// Mean stress in x [Pa] on the face that is pulled or sheared.
  double stress() const {
    const palpate::VectorX r = body_->reactions();
    double sum = 0.0;
    for (palpate::Index i = 0; i < mesh_.node_count(); ++i)
      if (mesh_.position(i)[shears() ? 1 : 0] > 1.0 - 1e-9) sum += r[3 * i];
    return sum;
  }
  /// Displacement [m] of the corner far from the origin.
  palpate::Vector3 corner() const {
    palpate::Index far = 0;
    for (palpate::Index i = 0; i < mesh_.node_count(); ++i)
      if (mesh_.position(i).sum() > mesh_.position(far).sum()) far = i;
    return body_->displacement().segment<3>(3 * far);
  }

  static constexpr double whole = 0.01, pull = 100.0;  ///< strain [-], traction [Pa]

 private:
  palpate::Scene scene() const {
    palpate::Scene scene;
    if (shears()) {
      for (const palpate::NodeId i : palpate::nodes_of(palpate::extract_boundary<E>(mesh_)))
        scene.prescribe(std::vector<palpate::NodeId>{i}, {whole * mesh_.position(i).y(), 0.0, 0.0});
      return scene;
    }
    const auto constrain = [&](const char* group, std::size_t axis, double u) {
      palpate::Components c;
      c[axis] = u;
      scene.prescribe(group, c);
    };
    constrain("x0", 0, 0.0);
    constrain("y0", 1, 0.0);
    constrain("z0", 2, 0.0);
    if (hold_ == "creep") return scene.traction("x1", {pull, 0.0, 0.0});
    constrain("x1", 0, whole);
    if (hold_ == "confined") {
      constrain("y1", 1, 0.0);
      constrain("z1", 2, 0.0);
    } else if (hold_ != "uniaxial_free" && hold_ != "ramp_uniaxial") {
      palpate::raise(SetupErrorKind::unsupported, "the constraints '" + hold_ + "' of a cube");
    }
    return scene;
  }

  palpate::Mesh<E> mesh_;
  std::string hold_;
  palpate::Viscoelastic<palpate::LinearElastic, 1> material_;
  std::optional<palpate::Equilibrium> body_;
  palpate::VectorX full_;
};

/// Storage and loss modulus [Pa] at every frequency of the table for which the transient decays within 100 periods.
template <palpate::Element E>
void oscillate(const palpate::Mesh<E>& mesh, const json& load_case, const Table& table, Course& course) {
  constexpr double full_circle = 2.0 * std::numbers::pi;
  constexpr int steps = 200;
  for (const auto& row : table.rows) {
    CubeInTime<E> cube(mesh, load_case);
    const double periods = std::ceil(20.0 * cube.tau() * row[0] / full_circle);
    if (periods > 100.0) break;
    double storage = 0.0, loss = 0.0;
    for (int k = 1; k <= steps * (1 + static_cast<int>(periods)); ++k) {
      const double angle = full_circle * k / steps;
      cube.step(full_circle / row[0] / steps, std::sin(angle));
      if (k <= steps * static_cast<int>(periods)) continue;
      storage += cube.stress() / cube.whole * std::sin(angle) * 2.0 / steps;
      loss += cube.stress() / cube.whole * std::cos(angle) * 2.0 / steps;
    }
    course.rows.push_back({row[0], storage, loss});
  }
  course.header = "omega,storage_G,loss_G";
  compare(course, table, {"storage_G", "loss_G"});
}

/// Computes a viscoelastic cube at the times of its table, with 20 steps between two rows. Throws SetupError.
template <palpate::Element E>
Course solve_cube_in_time(const palpate::Mesh<E>& mesh, const json& load_case) {
  const auto hold = load_case.at("hold").template get<std::string>(),
             law = load_case.at("law").template get<std::string>();
  const Table table(load_case.at("table").template get<std::string>());
  const auto start = std::chrono::steady_clock::now();
  Course course;
  if (hold == "harmonic") {
    oscillate(mesh, load_case, table, course);
  } else {
    CubeInTime<E> cube(mesh, load_case);
    const bool ramp = hold.starts_with("ramp"), creep = hold == "creep";
    double time = 0.0;
    for (const auto& row : table.rows) {
      const int steps = row[0] > 0.0 ? 20 : 1;
      for (int k = 0; k < steps; ++k) {
        const double now = time + (row[0] - time) * (k + 1) / steps;
        cube.step((row[0] - time) / steps, ramp ? std::min(1.0, now / 0.2) : 1.0);
      }
      time = row[0];
      course.rows.push_back({time, creep ? cube.corner().x() : cube.stress(), cube.corner().y()});
    }
    course.header = creep ? "t,strain,lateral_strain" : "t,stress,lateral_strain";
    const std::string sideways = "lateral_strain_shear_only_uniaxial_free";
    if (creep)
      compare(course, table, {"creep_strain_under_100Pa_uniaxial_all_moduli"});
    else if (ramp)
      compare(course, table, {hold == "ramp_shear" ? "ramp0.2s_shear_stress" : "ramp0.2s_uniaxial_stress_all_moduli"});
    else if (law + hold == "shear_onlyuniaxial_free")
      compare(course, table, {law + "__" + hold, sideways});
    else
      compare(course, table, {law + "__" + hold});
  }
  course.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return course;
}

/// Newmark's rule with the consistent mass, as in the table: the displacement of the loaded end. Throws SetupError.
template <palpate::Element E>
Course solve_bar_in_time(const palpate::Mesh<E>& mesh, const json& load_case) {
  const Table table(load_case.at("table").template get<std::string>());
  const json& m = load_case.at("material");
  const palpate::LinearElastic material{.youngs_modulus = m.at("E").template get<double>(),
                                        .poisson_ratio = m.at("nu").template get<double>(),
                                        .density = m.at("rho").template get<double>()};
  const double h = load_case.at("dt").template get<double>();
  palpate::Scene scene;
  scene.fix("fixed").traction("load", {1000.0, 0.0, 0.0});

  const auto start = std::chrono::steady_clock::now();
  palpate::Admitted<E> admitted = palpate::admit<E>(mesh);
  const palpate::Scene mapped = scene.mapped(admitted.node_map, palpate::Vector3::Zero());
  palpate::Index tip = 0;
  for (palpate::Index i = 0; i < admitted.mesh.node_count(); ++i)
    if (admitted.mesh.position(i).x() > admitted.mesh.position(tip).x()) tip = i;
  palpate::ImplicitDynamics motion(
      palpate::make_deformable_body(palpate::make_body(std::move(admitted.mesh), material), mapped),
      {.scheme = palpate::TimeScheme::newmark(), .mass = palpate::MassKind::consistent});
  Course course;
  course.header = "t,tip";
  for (const auto& row : table.rows) {
    while (motion.time() < row[0] - 0.5 * h)
      if (!motion.step(h).newton.converged) palpate::raise(SetupErrorKind::not_converged, "a step did not converge");
    course.rows.push_back({row[0], motion.displacement()[3 * tip]});
  }
  compare(course, table, {"tip_newmark_getfem"});
  course.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return course;
}

/// Writes <name>.csv.
template <palpate::Element E>
void write_csv(const std::filesystem::path& folder, const std::string& name, const NumberedMesh<E>&,
               const Course& course) {
  std::ofstream file = open_csv(folder / (name + ".csv"), course.header.c_str());
  for (const auto& row : course.rows)
    for (std::size_t k = 0; k < row.size(); ++k) file << row[k] << (k + 1 < row.size() ? ',' : '\n');
  if (!file.flush()) palpate::raise(SetupErrorKind::bad_file, folder.string() + ": writing failed");
}

/// The line printed for a time history.
inline nlohmann::ordered_json summary(const std::string& name, const std::string& element, const Course& course) {
  return {{"case", name},
          {"element", element},
          {"rows", course.rows.size()},
          {"largest_difference", course.error},
          {"seconds", course.seconds}};
}

}  // namespace solve_case
