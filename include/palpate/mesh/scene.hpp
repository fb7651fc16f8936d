// The supports, loads and touchable parts of a body: selections and conditions, independent of element and mesh.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/where.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Part of a mesh: the name of a group (or of a region, or "surface"), a list of nodes, or a set of points such as
/// `where::box(low, high)`, which selects by position in the mesh as given.
using Selection = std::variant<std::string, std::vector<NodeId>, where::PointSet>;

/// The same selection in an admitted mesh: listed node ids go through `map`, those mapped to -1 are dropped; a set of
/// points is moved to the frame of the admitted mesh, whose origin is `origin` in the frame of the mesh as given [m].
/// Throws index_out_of_range.
Selection mapped(const Selection& selection, const std::vector<NodeId>& map, const Vector3& origin);

/// Selects all elements where a region name is expected.
inline const std::string everywhere{};

/// Displacement per component [m]; an empty component stays free.
using Components = std::array<std::optional<double>, 3>;

/// What will touch a part of a scene.
struct TouchOptions {
  /// Radius of the smallest sphere that will touch [m]; 0: not known. A static model measures the error of the forces
  /// on that sphere if its options say so (model/static/measured_force_error.hpp).
  double radius = 0.0;
  /// Whether two such spheres may pinch: press at once from opposite sides, where both can be touched. The measured
  /// error is then the larger one of a single sphere and of two.
  bool pinched = false;
};

/// The conditions of a scene. Stores groups by name only; selections are resolved, and unknown or empty ones refused,
/// when a model is constructed. Every call throws SetupError(non_finite) on NaN or infinity.
class Scene {
 public:
  struct Prescribed {
    Selection where;
    Components values;
  };
  struct Traction {
    Selection where;
    Vector3 traction;
  };
  struct Pressure {
    Selection where;
    double pressure;
  };
  struct PointLoad {
    Selection where;
    Vector3 force;
  };
  struct BodyLoad {
    std::string region;
    Vector3 force_per_volume;
  };
  struct InitialStrain {
    std::string region;
    Vector6 strain;
  };

  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  /// Constrains all three displacement components of every node to zero (essential condition).
  Scene& fix(Selection where);

  /// Prescribes the displacement [m] of the given components (essential condition). Two different values for one
  /// component are refused when the model is constructed.
  Scene& prescribe(Selection where, Components values);
  /// Force per reference area [Pa] on the faces of a group (natural condition, eqs. 3.26, 3.42).
  Scene& traction(Selection where, const Vector3& value);
  /// Pressure [Pa] on boundary faces; a positive value pushes onto the surface. Dead load: its direction stays that of
  /// the reference normal.
  Scene& pressure(Selection where, double value);
  /// Total force [N], shared equally by the nodes of the group.
  Scene& point_load(Selection where, const Vector3& force);
  /// Acceleration [m/s^2]; the load is density times acceleration (eqs. 3.27, 3.44). Replaces an earlier one.
  Scene& gravity(const Vector3& acceleration);
  /// Force per reference volume [N/m^3] on a region, or `everywhere`.
  Scene& body_load(std::string region, const Vector3& force_per_volume);
  /// Stress-free strain epsilon_0 (Voigt order of core/voigt.hpp, engineering shear) of a region, or `everywhere`:
  /// swelling, contraction, thermal expansion (eqs. 3.1, 3.28).
  Scene& initial_strain(std::string region, const Vector6& strain);
  /// Stress-free growth of a region, or `everywhere`: without constraints every length would become 1 + elongation
  /// times its reference length, equally in all directions; a negative value shrinks. Adds to other initial strains
  /// there. Swelling by a volume fraction v is an elongation of v / 3 (small strain).
  Scene& expand(std::string region, double elongation);
  /// Thermal expansion of a region, or `everywhere`: coefficient [1/K] times rise of temperature [K].
  Scene& thermal_strain(std::string region, double coefficient, double rise);
  /// The part a tool may touch: the dofs of these nodes are kept, all others are condensed away. A set of points
  /// selects only boundary faces all of whose nodes it contains. Throws bad_argument for a negative radius.
  Scene& touch(Selection where, const TouchOptions& options = {});
  /// Nodes to be displayed: their displacement is recovered at visual rate.
  Scene& render(Selection where);

  const std::vector<Prescribed>& prescribed() const noexcept { return prescribed_; }
  const std::vector<Traction>& tractions() const noexcept { return tractions_; }
  const std::vector<Pressure>& pressures() const noexcept { return pressures_; }
  const std::vector<PointLoad>& point_loads() const noexcept { return point_loads_; }
  const std::vector<BodyLoad>& body_loads() const noexcept { return body_loads_; }
  const std::vector<InitialStrain>& initial_strains() const noexcept { return initial_strains_; }
  const std::vector<Selection>& touched() const noexcept { return touched_; }
  const std::vector<Selection>& rendered() const noexcept { return rendered_; }
  /// Least radius of the spheres that will touch [m]; 0: not known.
  double touch_radius() const noexcept { return touch_radius_; }
  /// Whether two spheres may pinch some part (TouchOptions::pinched).
  bool is_pinched() const noexcept { return is_pinched_; }
  const Vector3& gravity() const noexcept { return gravity_; }

  /// The same scene with every selection of nodes replaced by what `change` makes of it.
  Scene with_selections(const std::function<Selection(const Selection&)>& change) const;
  /// The same scene for an admitted mesh, see `mapped` of a Selection.
  Scene mapped(const std::vector<NodeId>& map, const Vector3& origin) const;

  /// Text that lists all loads except gravity: "2 pressures, prescribed displacements"; empty if there are none.
  std::string loads_in_words() const;

  /// Names of all groups that the scene uses.
  std::vector<std::string> group_names() const;

 private:
  static void require_finite(double value, const char* what);

  std::vector<Prescribed> prescribed_;
  std::vector<Traction> tractions_;
  std::vector<Pressure> pressures_;
  std::vector<PointLoad> point_loads_;
  std::vector<BodyLoad> body_loads_;
  std::vector<InitialStrain> initial_strains_;
  std::vector<Selection> touched_;
  std::vector<Selection> rendered_;
  Vector3 gravity_ = Vector3::Zero();
  double touch_radius_ = 0.0;
  bool is_pinched_ = false;
};

namespace detail {

/// Text that lists all loads, with gravity [m/s^2]: "gravity of 9.81 m/s^2, 2 pressures".
std::string loads_in_words(const Vector3& gravity, const std::string& others);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/scene.ipp>
#endif
