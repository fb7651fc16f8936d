#include "program.hpp"

#include "laws.hpp"
#include "tissue.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <initializer_list>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace cross {

namespace {

/// More nodes than this are moved by a copy of the loop that moved them, fewer by their positions.
constexpr std::size_t most_listed = 20;

/// The shortest text that is read as the same number, with the type double.
std::string text_of(double value) {
  char text[40];
  std::string number(text, std::to_chars(text, text + sizeof text, value == 0.0 ? 0.0 : value).ptr);
  return number.find_first_of(".en") == std::string::npos ? number + ".0" : number;
}
std::string text_of(int value) {
  return std::to_string(value);
}
std::string text_of(const Vector3& v) {
  return text_of(v[0]) + ", " + text_of(v[1]) + ", " + text_of(v[2]);
}
std::string quoted(const std::string& text) {
  return '"' + text + '"';
}
std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}
/// ".name = value" for an initialiser.
template <class Number>
std::string member(const char* name, Number value) {
  return "." + std::string(name) + " = " + text_of(value);
}
std::string members(std::initializer_list<std::pair<const char*, double>> values) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : values) parts.push_back(member(name, value));
  return joined(parts);
}

/// A word in a program: its type, and the header of a feature that palpate.hpp does not include.
struct Type {
  std::string name;
  std::string header{};
};

const Type& type_of(const std::string& word) {
  static const std::string soft = "palpate/soft.hpp", cut = "palpate/cut.hpp", elements = "palpate/elements.hpp",
                           cut_moving = "palpate/cut/cuttable_moving.hpp", materials = "palpate/materials.hpp";
  static const std::map<std::string, Type> types{
      {"tet4", {"Tet4"}},
      {"smoothed_tet4", {"Smoothed<Tet4>"}},
      {"tet10", {"Tet10", elements}},
      {"hex8", {"Hex8", elements}},
      {"hex20", {"Hex20", elements}},
      {"mean_dilatation_hex8", {"MeanDilatation<Hex8>", elements}},
      {"linear", {"LinearElastic"}},
      {"transversely_isotropic", {"TransverselyIsotropic", materials}},
      {"orthotropic", {"Orthotropic", materials}},
      {"corotational", {"Corotational", soft}},
      {"st_venant_kirchhoff", {"StVenantKirchhoff", soft}},
      {"neo_hookean", {"NeoHookean", soft}},
      {"neo_hookean_logarithmic", {"NeoHookeanLogarithmic", soft}},
      {"neo_hookean_isochoric", {"NeoHookeanIsochoric", soft}},
      {"mooney_rivlin", {"MooneyRivlin", soft}},
      {"fibre_reinforced", {"FibreReinforced<NeoHookean>", soft}},
      {"viscoelastic", {"Viscoelastic<NeoHookean, 1>", soft}},
      {"condensed", {"Condensed<SelectiveInverse>"}},
      {"condensed_float", {"Condensed<SelectiveInverseFloat>"}},
      {"condensed_cholesky", {"Condensed<DenseCholesky>"}},
      {"condensed_cg", {"Condensed<ConjugateGradient>"}},
      {"sparse_cholesky", {"SparseCholesky"}},
      {"cg", {"ConjugateGradient"}},
      {"matrix_free_cg", {"WithAssembly<ConjugateGradient, MatrixFree>"}},
      {"inverse", {"SelectiveInverse"}},
      {"stiffening", {"Stiffening<Condensed<SelectiveInverse>>", soft}},
      {"newton", {"Implicit<Newton>", soft}},
      {"corotated_cg", {"Implicit<MatrixFreeCG<BlockJacobi>>", soft}},
      {"quasi_newton", {"Implicit<QuasiNewton<double>>", soft}},
      {"quasi_newton_float", {"Implicit<QuasiNewton<float>>", soft}},
      {"central_difference", {"Explicit<CentralDifference>", soft}},
      {"semi_implicit_euler", {"Explicit<SemiImplicitEuler>", soft}},
      {"cut_condensed", {"Cuttable<Condensed<SelectiveInverse>>", cut}},
      {"cut_quasi_newton", {"Cuttable<Implicit<QuasiNewton<double>>>", cut_moving}},
      {"cut_quasi_newton_float", {"Cuttable<Implicit<QuasiNewton<float>>>", cut_moving}}};
  return types.at(word);
}

/// The material of a law, without its type. Values are those of laws.hpp.
std::string material_of(const Scene& scene, double youngs_modulus) {
  const Stiffness s{youngs_modulus, scene.poisson_ratio, scene.density, Matrix3::Identity()};
  const std::string plain =
      members({{"youngs_modulus", s.youngs_modulus}, {"poisson_ratio", s.poisson_ratio}, {"density", s.density}});
  if (scene.law == "transversely_isotropic") {
    const auto m = Law<palpate::TransverselyIsotropic>::make(s);
    return members({{"youngs_modulus_along", m.youngs_modulus_along},
                    {"youngs_modulus_across", m.youngs_modulus_across},
                    {"poisson_ratio_along", m.poisson_ratio_along},
                    {"poisson_ratio_across", m.poisson_ratio_across},
                    {"shear_modulus_along", m.shear_modulus_along},
                    {"density", m.density}});
  }
  if (scene.law == "orthotropic") {
    const auto m = Law<palpate::Orthotropic>::make(s);
    return members({{"youngs_modulus_1", m.youngs_modulus_1},
                    {"youngs_modulus_2", m.youngs_modulus_2},
                    {"youngs_modulus_3", m.youngs_modulus_3},
                    {"poisson_ratio_12", m.poisson_ratio_12},
                    {"poisson_ratio_13", m.poisson_ratio_13},
                    {"poisson_ratio_23", m.poisson_ratio_23},
                    {"shear_modulus_12", m.shear_modulus_12},
                    {"shear_modulus_13", m.shear_modulus_13},
                    {"shear_modulus_23", m.shear_modulus_23},
                    {"density", m.density}});
  }
  if (scene.law == "mooney_rivlin") {
    const auto m = Law<palpate::MooneyRivlin>::make(s);
    return members({{"c10", m.c10}, {"c01", m.c01}, {"bulk_modulus", m.bulk_modulus}, {"density", m.density}});
  }
  if (scene.law == "fibre_reinforced") {
    const auto m = Law<palpate::FibreReinforced<palpate::NeoHookean>>::make(s);
    return ".base = {" + plain + "}, " + member("k1", m.k1);
  }
  if (scene.law == "viscoelastic") {
    const palpate::PronyTerm term = Law<palpate::Viscoelastic<palpate::NeoHookean, 1>>::make(s).terms[0];
    return ".base = {" + plain + "}, .terms = {{{" +
           members({{"share", term.share}, {"relaxation_time", term.relaxation_time}}) + "}}}";
  }
  return plain;
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> some) {
  return std::ranges::find(some, word) != some.end();
}
bool is_explicit(const Scene& scene) {
  return is_one_of(scene.solver, {"central_difference", "semi_implicit_euler"});
}

/// The positions of the nodes of a body.
const std::vector<Vector3>& positions_of(const Scene& scene, const Body& body) {
  return is_hexahedral(scene) ? body.hexahedra.positions : body.tetrahedra.positions;
}
/// The nodes that differ between two scenes with the same mesh.
std::vector<std::size_t> moved_nodes(const std::vector<Vector3>& before, const std::vector<Vector3>& after) {
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (before[i] != after[i]) moved.push_back(i);
  return moved;
}

/// The text of one program.
class Program {
 public:
  explicit Program(const Scene& scene)
      : s_(scene), body_(make_body(scene)), several_(scene.tools.size() > 1), rotated_(scene.pose == "rotated") {}

  std::string text() {
    mesh();
    conditions();
    tissue();
    servo();
    loop();
    return head() + lines_ + "}\n";
  }

 private:
  /// A line of main.
  void line(const std::string& text) { lines_ += "  " + text + "\n"; }
  void inner(const std::string& text) { line("  " + text); }
  void gap() { lines_ += "\n"; }

  std::string head() const {
    std::string text =
        "// g++ -std=c++20 -O2 -I<palpate>/include -I<eigen> x.cpp -pthread\n#include <palpate/palpate.hpp>\n";
    for (const std::string& header : headers_)
      if (header.starts_with("palpate/")) text += "#include <" + header + ">\n";
    for (const std::string& header : headers_)
      if (!header.starts_with("palpate/")) text += "#include <" + header + ">\n";
    return text + "using namespace palpate;\n\nint main() {\n";
  }

  // Body

  std::string linear_element() const { return is_hexahedral(s_) ? "Hex8" : "Tet4"; }
  double radius() const { return 0.5 * (2.0 * s_.edge * s_.cells_x); }

  void mesh() {
    const std::string cells = joined({text_of(s_.cells_x), text_of(s_.cells_y), text_of(s_.cells_z)});
    if (is_round(s_)) {
      headers_.insert("palpate/mesh/generators.hpp");
      line("auto mesh = sphere_tet4(" + text_of(radius()) + ", " + text_of(s_.cells_x) + ");");
      round_groups();
    } else {
      line("const Vector3 size = " + text_of(s_.edge) + " * Vector3(" + cells + ");");
      line(std::string("auto mesh = ") + (is_hexahedral(s_) ? "box_hex8" : "box_tet4") + "(size, {" + cells + "}, " +
           (is_hexahedral(s_) ? "" : "BoxSplit::five_mirrored, ") + "{-0.5 * size[0], -0.5 * size[1], 0.0});");
    }
    regions();
    if (is_one_of(s_.law, {"transversely_isotropic", "fibre_reinforced"}))
      line("mesh.fibres.assign(mesh.elements.size(), Vector3::UnitX());");
    curve();
    move_nodes();
  }

  void round_groups() {
    headers_.insert("algorithm"), headers_.insert("iterator");
    const auto lambda = [this](const char* name, const char* sign, double part) {
      line("const auto " + std::string(name) + " = [&](NodeId node) { return mesh.position(node)[2] " + sign + " " +
           text_of(part * s_.edge * s_.cells_x) + "; };");
    };
    lambda("low", "<", -0.4);
    if (s_.touched == "top") lambda("high", ">", -0.2);
    line("Group support{\"support\", 2, {}, {}, {}}, touchable{\"touchable\", 2, {}, {}, {}};");
    line("for (const BoundaryFace& face : extract_boundary<Tet4>(mesh)) {");
    inner("const std::vector<NodeId> nodes(face.nodes.begin(), face.nodes.end());");
    inner("std::ranges::copy_if(nodes, std::back_inserter(support.nodes), low);");
    inner("if (std::ranges::all_of(nodes, low)) support.faces.push_back(nodes);");
    if (s_.touched != "whole")
      inner(s_.touched == "surface" ? "if (std::ranges::all_of(nodes, low)) continue;"
                                    : "if (!std::ranges::all_of(nodes, high)) continue;");
    inner("touchable.faces.push_back(nodes);");
    inner("touchable.nodes.insert(touchable.nodes.end(), nodes.begin(), nodes.end());");
    line("}");
    line("mesh.groups.all() = {support, touchable};");
    line("mesh.groups.tidy();");
  }

  /// The second region: where a vector from the middle of the uncurved body to the centre of an element is in it.
  void regions() {
    if (body_.moduli.size() < 2) return;
    const double extent = largest_extent(), height = is_round(s_) ? 0.0 : 0.5 * s_.edge * s_.cells_z;
    line("mesh.region_names = {\"first\", \"second\"};");
    line("mesh.regions.clear();");
    line("for (const auto& element : mesh.elements) {");
    inner("Vector3 centre = Vector3::Zero();");
    inner("for (NodeId node : element) centre += mesh.position(node);");
    inner("centre = centre / " + std::string(is_hexahedral(s_) ? "8" : "4") + " - Vector3(0.0, 0.0, " +
          text_of(height) + ");");
    inner("mesh.regions.push_back(" + second_region(extent) + " ? 1 : 0);");
    line("}");
  }
  double largest_extent() const {
    if (is_round(s_)) return 2.0 * s_.edge * s_.cells_x;
    return s_.edge * std::max({s_.cells_x, s_.cells_y, s_.cells_z});
  }
  std::string second_region(double extent) const {
    if (body_.division == "half") return "centre[0] > " + text_of(1e-9 * extent);
    if (body_.division == "layer") return "centre[2] < " + text_of(-1e-9 * extent);
    return "centre.norm() < " + text_of(0.25 * extent);
  }
  void curve() {
    if (!is_one_of(s_.body, {"dome", "tube", "organ"})) return;
    headers_.insert("cmath");
    line("const auto curve = [&](const Vector3& q) -> Vector3 {");
    const Vector3 extent(s_.edge * Vector3(s_.cells_x, s_.cells_y, s_.cells_z));
    if (s_.body == "dome") dome(extent);
    if (s_.body == "tube") tube(extent);
    if (s_.body == "organ") organ();
    line("};");
    line("for (Vector3& x : mesh.positions) x = curve(x);");
  }
  void dome(const Vector3& extent) {
    const double outer = std::max({extent[0], extent[1], 2.0 * extent[2]});
    const std::string all = text_of(outer);
    inner("const double inner = " + text_of(outer - extent[2]) + ";");
    inner("const Vector3 out = Vector3(std::tan(q[0] / " + all + "), std::tan(q[1] / " + all + "), 1.0).normalized();");
    inner("return (inner + q[2]) * out - inner * Vector3::UnitZ();");
  }
  void tube(const Vector3& extent) {
    const double mean = std::max(extent[0] / std::numbers::pi, 1.5 * extent[2]);
    inner("const double angle = q[0] / " + text_of(mean) + ", radius = " + text_of(mean) + " + q[2] - " +
          text_of(0.5 * extent[2]) + ";");
    inner("return {radius * std::sin(angle), q[1], radius * std::cos(angle)};");
  }
  void organ() {
    inner("const Vector3 s = q / " + text_of(radius()) + ";");
    inner("const double bulge = 0.2 * std::exp(-4.0 * (s - Vector3(0.5, 0.3, 0.6)).squaredNorm());");
    inner("return " + text_of(radius()) +
          " * (Vector3(1.3 * s[0], s[1], 0.8 * s[2]) + bulge * Vector3(0.3, 0.2, 1.0).normalized());");
  }

  /// Jitter and slivers: a few nodes are moved by their positions; many by the loop that moved them.
  void move_nodes() {
    Scene even = s_, without_slivers = s_;
    even.jitter = 0.0, even.slivers = without_slivers.slivers = 0;
    const std::vector<Vector3> start = positions_of(s_, make_body(even)),
                               shaken = positions_of(s_, make_body(without_slivers)), end = positions_of(s_, body_);
    const bool by_loop = moved_nodes(start, shaken).size() > most_listed;
    if (by_loop) jitter_loop();
    for (const std::size_t node : moved_nodes(by_loop ? shaken : start, end))
      line("mesh.positions[" + std::to_string(node) + "] = {" + text_of(end[node]) + "};");
  }
  void jitter_loop() {
    for (const char* header : {"algorithm", "palpate/mesh/quality.hpp", "palpate/testing/random.hpp"})
      headers_.insert(header);
    const std::string e = linear_element();
    line("const std::vector<NodeId> outside = nodes_of(extract_boundary<" + e + ">(mesh));");
    line("std::vector<std::vector<Index>> around(mesh.positions.size());");
    line("for (Index e = 0; e < mesh.element_count(); ++e)");
    inner("for (NodeId node : mesh.elements[e]) around[node].push_back(e);");
    line("const auto is_good = [&](Index e) {");
    inner("return element_shape<" + e + ">(element_nodes<" + e + ">(mesh, e)).quality >= 0.05;");
    line("};");
    line("testing::Random random(" + std::to_string(s_.seed) + ");");
    line("for (NodeId node = 0; node < mesh.node_count(); ++node) {");
    inner("if (std::ranges::find(outside, node) != outside.end()) continue;");
    inner("const Vector3 before = mesh.positions[node];");
    inner("Vector3 shift = " + text_of(s_.jitter * s_.edge) + " * random.vector<3>(-1.0, 1.0);");
    inner("for (int attempt = 0; attempt < 12; ++attempt, shift *= 0.5) {");
    inner("  mesh.positions[node] = before + shift;");
    inner("  if (std::ranges::all_of(around[node], is_good)) break;");
    inner("  mesh.positions[node] = before;");
    inner("}");
    line("}");
  }

  // Conditions

  std::vector<std::string> support_groups() const {
    if (is_round(s_)) return {"support"};
    if (s_.support == "bottom") return {"z0"};
    return s_.support == "sides" ? std::vector<std::string>{"x0", "x1"} : std::vector<std::string>{"x0"};
  }
  std::vector<std::string> touchable_groups() const {
    if (is_round(s_)) return {"touchable"};
    if (s_.touched == "top") return {"z1"};
    std::vector<std::string> groups;
    for (const char* side : {"x0", "x1", "y0", "y1", "z0", "z1"})
      if (s_.touched == "whole" || std::ranges::count(support_groups(), side) == 0) groups.emplace_back(side);
    return groups;
  }

  void conditions() {
    const palpate::Scene& c = body_.conditions;
    if (s_.support_travels != 0.0) return moving_conditions();
    line("Scene scene;");
    std::string on_supports;
    for (const std::string& group : support_groups())
      on_supports += s_.support_moves == 0.0 ? ".fix(" + quoted(group) + ")"
                                             : ".prescribe(" + quoted(group) + ", {" + prescribed() + "})";
    const std::vector<std::string> touchable = touchable_groups();
    if (touchable.size() == 1) {
      line("scene" + on_supports + on_touchable(quoted(touchable[0])) + ";");
    } else {
      line("scene" + on_supports + ";");
      std::vector<std::string> sides;
      for (const std::string& side : touchable) sides.push_back(quoted(side));
      line("for (const char* side : {" + joined(sides) + "}) scene" + on_touchable("side") + ";");
    }
    if (!c.gravity().isZero(0.0)) line("scene.gravity({" + text_of(c.gravity()) + "});");
    for (const auto& load : c.body_loads())
      line("scene.body_load(everywhere, {" + text_of(load.force_per_volume) + "});");
    for (const auto& load : c.point_loads())
      line("scene.point_load(std::vector<NodeId>{" +
           std::to_string(std::get<std::vector<palpate::NodeId>>(load.where).at(0)) + "}, {" + text_of(load.force) +
           "});");
    if (s_.load == "swelling") line("scene.expand(everywhere, " + text_of(s_.load_size) + ");");
  }
  /// Of a support that goes away by `x`, and comes back.
  void moving_conditions() {
    std::string touched;
    for (const std::string& group : touchable_groups()) touched += on_touchable(quoted(group));
    line("const auto scene_at = [](double x) {");
    inner("return Scene().fix(\"x0\").prescribe(\"x1\", {x, 0.0, 0.0})" + touched + ";");
    line("};");
    line("const Scene scene = scene_at(0.0);");
  }
  std::string prescribed() const {
    const palpate::Components& values = body_.conditions.prescribed().at(0).values;
    return text_of(Vector3(values[0].value(), values[1].value(), values[2].value()));
  }
  std::string on_touchable(const std::string& group) const {
    std::string text = ".touch(" + group;
    if (body_.conditions.touch_radius() > 0.0)
      text += ", {.radius = " + text_of(body_.conditions.touch_radius()) +
              (body_.conditions.is_pinched() ? ", .pinched = true}" : "}");
    text += ")";
    for (const auto& load : body_.conditions.pressures())
      text += ".pressure(" + group + ", " + text_of(load.pressure) + ")";
    for (const auto& load : body_.conditions.tractions())
      text += ".traction(" + group + ", {" + text_of(load.traction) + "})";
    return text;
  }

  // Tissue

  std::string use(const std::string& word) {
    const Type& type = type_of(word);
    if (!type.header.empty()) headers_.insert(type.header);
    return type.name;
  }

  void tissue() {
    const std::string element = use(s_.element), law = use(s_.law);
    gap();
    line("using Tissue = HapticFEModel<" + element + ", " + law + ", " + use(s_.solver) + ">;");
    std::string arguments = is_one_of(s_.element, {"tet10", "hex20"}) ? "promote<" + element + ">(mesh)" : "mesh";
    arguments += ", scene, " + materials(law);
    const std::string options = setup_options(), values = parameters();
    if (!options.empty() || !values.empty()) arguments += ", {" + options + "}";
    if (!values.empty()) arguments += ", {" + values + "}";
    line("Tissue tissue(" + arguments + ");");
    if (rotated_) {
      line("const Eigen::Isometry3d pose =");
      inner("  Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(2.0, Vector3(1.0, 2.0, 3.0).normalized());");
      line("tissue.set_pose(pose);");
    }
    member_of(arguments);
  }
  /// Of one region its material; of two a variable before the tissue.
  std::string materials(const std::string& law) {
    if (body_.moduli.size() == 1) return law + "{" + material_of(s_, body_.moduli[0]) + "}";
    line("const RegionMaterials<" + law + "> materials{");
    for (std::size_t r = 0; r < 2; ++r)
      inner("  {\"" + std::string(r == 0 ? "first" : "second") + "\", {" + material_of(s_, body_.moduli[r]) + "}}" +
            (r == 0 ? "," : "};"));
    return "materials";
  }
  std::string setup_options() {
    std::vector<std::string> options;
    if (s_.threads != 1) options.push_back(member("threads", s_.threads));
    if (is_one_of(s_.solver, {"condensed_cholesky", "condensed_cg", "sparse_cholesky", "cg", "matrix_free_cg"}))
      options.emplace_back(".columns = ColumnFill::synchronous");
    if (s_.measured || s_.corrected) {
      headers_.insert("palpate/model/static/measured_force_error.hpp");
      options.emplace_back(".force_error = measured_force_error()");
    }
    return joined(options);
  }
  std::string parameters() const {
    if (s_.solver == "stiffening") {
      const std::string start = "StiffeningCurve({{0.0, 1.0}, {" + text_of(0.1 * body_.size) + ", ";
      return ".axial = " + start + "1.5}}), .radial = " + start + "1.2}})";
    }
    if (!moves(s_.solver)) return {};
    std::string text = member("step", is_explicit(s_) ? explicit_step() : s_.step);
    if (s_.solver.find("quasi_newton") != std::string::npos && !s_.inertia) text += ", .inertia = false";
    return text;
  }
  /// The step that the tissue takes: that of the scene may be shortened.
  double explicit_step() const {
    try {
      const Composition* composition = find_composition(s_.element, s_.law, s_.solver);
      return composition == nullptr ? s_.step : composition->make(s_, body_, {})->interval();
    } catch (const std::exception&) {
      return s_.step;  // the program is refused, too
    }
  }
  void member_of(const std::string& arguments) {
    if (s_.member == "adaptor") line("TissueAdaptor<Tissue> adaptor(tissue);");
    if (s_.member == "group") headers_.insert("palpate/tools.hpp"), line("TissueGroup group(tissue);");
    if (s_.member != "pair") return;
    const double far = 10.0 * body_.size;
    line("Tissue second(" + arguments + ");");
    line("second.set_pose(" + std::string(rotated_ ? "pose * " : "Eigen::Isometry3d(") + "Eigen::Translation3d(" +
         text_of(Vector3(far, far, 0.0)) + ")" + (rotated_ ? "" : ")") + ");");
    headers_.insert("palpate/tools.hpp");
    line("TissueGroup group(tissue, second);");
  }

  // Servo

  Place place(const ToolValue& tool) const { return place_of(s_, tool.u, tool.v, tool.opposite); }

  std::string tool_text(const ToolValue& tool) const {
    const Place at = place(tool);
    if (tool.kind == "capsule")
      return "CapsuleTool(" + text_of(tool.radius) + ", " + text_of(2.0 * tool.radius) + ", {" + text_of(at.along) +
             "})";
    if (tool.kind == "plate") return plate_text(tool, at);
    if (tool.kind != "blade") return "SphereTool{" + member("radius", tool.radius) + "}";
    return "BladeTool{.edge = " + std::string(rotated_ ? "pose.linear() * Vector3(" : "{") +
           text_of(Vector3(4.0 * tool.radius * at.along)) + (rotated_ ? ")" : "}") + ", " +
           members({{"toughness", 20.0}, {"cut_spacing", 0.25 * s_.edge}}) + "}";
  }
  static std::string plate_text(const ToolValue& tool, const Place& at) {
    const Vector3 across = at.normal.cross(at.along);
    std::vector<std::string> points;
    for (const double x : {-1.5, 1.5})
      for (const double y : {-1.0, 1.0})
        points.push_back("{" + text_of(Vector3(tool.radius * (x * at.along + y * across))) + "}");
    return "ConvexTool({" + joined(points) + "}, " + text_of(0.5 * tool.radius) + ")";
  }

  void servo() {
    gap();
    std::string tools = tool_text(s_.tools[0]);
    if (several_) {
      tools = "tools";
      line("const ToolList tools{");
      for (std::size_t t = 0; t < s_.tools.size(); ++t)
        inner("  " + tool_text(s_.tools[t]) + (t + 1 < s_.tools.size() ? "," : "};"));
    }
    const bool grouped = s_.member == "group" || s_.member == "pair";
    const std::string options = servo_options();
    line("HapticServo servo(" +
         std::string(s_.member == "adaptor" ? "adaptor"
                     : grouped              ? "group"
                                            : "tissue") +
         ", " + tools + (options.empty() ? "" : ", {" + options + "}") + ");");
  }
  std::string servo_options() const {
    const palpate::DeviceLimits plain;
    std::vector<std::string> options, contact;
    if (s_.rate != static_cast<int>(plain.rate)) options.push_back(member("rate", double(s_.rate)));
    if (s_.coupling != plain.stiffness || !options.empty())
      options.push_back(member("coupling_stiffness", s_.coupling));
    if (s_.friction != 0.0) contact.push_back(member("friction", s_.friction));
    if (s_.capacity != 0) contact.push_back(member("capacity", s_.capacity));
    if (!contact.empty()) options.push_back(".contact = {" + joined(contact) + "}");
    if (s_.corrected) options.emplace_back(".corrected_force = true");
    if (std::ranges::any_of(s_.tools, &ToolValue::grasps)) options.emplace_back(".grasp_buttons = 1");
    return joined(options);
  }

  // Path

  int part_of(double part) const { return static_cast<int>(std::lround(part * s_.ticks)); }
  int middle() const { return (first_hold(s_) + last_hold(s_)) / 2; }
  static std::string divisor(int ticks) { return text_of(static_cast<double>(std::max(1, ticks))); }
  bool has_path(const char* path) const {
    return std::ranges::any_of(s_.tools, [&](const ToolValue& t) { return t.path == path; });
  }
  std::string condition(int from, int to) const { return "tick >= " + text_of(from) + " && tick < " + text_of(to); }

  void loop() {
    for (const char* header : {"algorithm", "cmath", "iostream", "numbers"}) headers_.insert(header);
    gap();
    line("const auto smooth = [](double part) {");
    inner("return 0.5 * (1.0 - std::cos(std::numbers::pi * std::clamp(part, 0.0, 1.0)));");
    line("};");
    line("std::cout.precision(9);");
    if (works()) line("double due = 0.0;");
    line("for (int tick = 0; tick < " + text_of(s_.ticks) + "; ++tick) {");
    inner("const double now = tick / " + text_of(double(s_.rate)) + ";");
    cuts();
    if (s_.support_travels != 0.0) {
      inner("const double away = tick / " + divisor(part_of(0.7)) + ";");
      inner("for (; due <= now; due += tissue.step()) {");
      inner("  tissue.set_conditions(scene_at(" + text_of(s_.support_travels * s_.edge * s_.cells_x) +
            " * smooth(2.0 * std::min(away, 1.0 - away))));");
      inner("  tissue.background_work();");
      inner("}");
    } else if (moves(s_.solver)) {
      inner("for (; due <= now; due += tissue.step()) tissue.background_work();");
    }
    if (s_.solver == "cut_condensed") {
      inner("for (; due <= now; due += 1e-3)");
      inner("  while (tissue.background_work().worked) continue;");
    }
    progress();
    states();
    output();
    line("}");
  }
  bool works() const { return moves(s_.solver) || s_.solver == "cut_condensed"; }

  /// Planes through the body across its x axis, as run.cpp cuts them.
  void cuts() {
    if (!can_be_cut(s_.solver)) return;
    for (int i = 0; i < s_.cuts; ++i) {
      const Place at = place_of(s_, 0.317 + 0.153 * i, 0.523, false);
      const Vector3 across = at.normal.cross(at.along);
      const double half = 3.0 * s_.edge, deep = 0.8 * s_.edge;
      std::vector<std::string> corners;
      for (const double n : {-deep, s_.edge})
        for (const double a : {-half, half}) {
          const std::string x = text_of(Vector3(at.point + a * across + n * at.normal));
          corners.push_back(rotated_ ? "pose * Vector3(" + x + ")" : "{" + x + "}");
        }
      inner("if (tick == " + text_of((i + 1) * s_.ticks / (s_.cuts + 2)) + ")");
      inner("  tissue.cut(BladeSweep{" + joined(corners) + "});");
    }
  }

  /// How far the tools are in, and how far aside.
  void progress() {
    const int first = first_hold(s_), last = last_hold(s_), out = part_of(0.95) - part_of(0.7);
    inner("const double in = tick <= " + text_of(last) + " ? smooth(tick / " + divisor(first) +
          ") : 1.0 - smooth((tick - " + text_of(last) + ") / " + divisor(out) + ");");
    if (!has_path("slide") && !has_path("twist")) return;
    inner("const double hold = std::clamp((tick - " + text_of(first) + ") / " + divisor(last - first) + ", 0.0, 1.0);");
    inner("const double aside = smooth(2.0 * std::min(hold, 1.0 - hold));");
  }
  std::string depth_text(const ToolValue& tool) const {
    const double unit = tool.kind == "blade" ? s_.edge : tool.radius;
    std::string depth = text_of(unit) + " * (-0.5 + " + text_of(tool.depth + 0.5) + " * in)";
    if (tool.path == "leap")
      depth = condition(middle(), middle() + 5) + " ? " + text_of(-10.0 * tool.radius) + " : " + depth;
    return depth;
  }
  void states() {
    if (several_) {
      headers_.insert("array");
      const std::string count = std::to_string(s_.tools.size());
      inner("const std::array<double, " + count + "> depth{");
      for (std::size_t t = 0; t < s_.tools.size(); ++t)
        inner("    " + depth_text(s_.tools[t]) + (t + 1 < s_.tools.size() ? "," : "};"));
      inner("std::array<ToolState, " + count + "> states;");
      inner("for (ToolState& state : states) state.time = state.now = now;");
    } else {
      inner("const double depth = " + depth_text(s_.tools[0]) + ";");
      inner("ToolState state;");
      inner("state.time = state.now = now;");
    }
    for (std::size_t t = 0; t < s_.tools.size(); ++t) state(s_.tools[t], several_ ? "[" + std::to_string(t) + "]" : "");
  }
  void state(const ToolValue& tool, const std::string& index) {
    const Place at = place(tool);
    const std::string state = (several_ ? "states" : "state") + index;
    const double reach = tool.kind == "blade" ? 0.0 : tool.kind == "plate" ? 0.5 * tool.radius : tool.radius;
    std::string position = "Vector3(" + text_of(at.point) + ") + (" + text_of(reach) + " - depth" + index +
                           ") * Vector3(" + text_of(at.normal) + ")";
    if (tool.path == "slide")
      position += " + " + text_of(tool.travel * tool.radius) + " * aside * Vector3(" + text_of(at.along) + ")";
    inner(state + ".position = " + (rotated_ ? "pose * Vector3(" + position + ")" : position) + ";");
    orientation(tool, at, state);
    if (tool.path == "lost")
      inner(state + ".valid = tick < " + text_of(middle()) + " || tick >= " + text_of(middle() + 8) + ";");
    if (tool.grasps) {
      const int first = first_hold(s_), last = last_hold(s_);
      inner(state + ".buttons = " + condition(first, last + (part_of(0.7) - first) / 2) + " ? 1 : 0;");
    }
  }
  /// The device rotates with the tissue; a twist is about the normal of its place.
  void orientation(const ToolValue& tool, const Place& at, const std::string& state) {
    if (!rotated_ && tool.path != "twist") return;
    const std::string twist = "Eigen::AngleAxisd(0.6 * aside, Vector3(" + text_of(at.normal) + ")).toRotationMatrix()";
    const std::string rotation = tool.path != "twist" ? "pose.linear()" : rotated_ ? "pose.linear() * " + twist : twist;
    inner("{");
    inner("  const auto q = Eigen::Quaterniond(Matrix3(" + rotation + ")).normalized();");
    inner("  " + state + ".orientation = {q.w(), q.x(), q.y(), q.z()};");
    inner("}");
  }
  void output() {
    if (!several_) {
      inner("const Status status = servo.tick(state).status;");
      inner("if (tick % 10 == 0)");
      inner(
          "  std::cout << tick << ' ' << depth << ' ' << servo.tick_view().contact_force().transpose() << ' ' << "
          "status << '\\n';");
      return;
    }
    inner("const auto forces = servo.tick(states);");
    inner("if (tick % 10 != 0) continue;");
    inner("std::cout << tick;");
    inner("for (std::size_t t = 0; t < depth.size(); ++t)");
    inner(
        "  std::cout << \"  \" << depth[t] << ' ' << servo.tick_view().contact_force(t).transpose() << ' ' << "
        "forces[t].status;");
    inner("std::cout << '\\n';");
  }

  const Scene& s_;
  Body body_;
  bool several_, rotated_;
  std::string lines_;
  std::set<std::string> headers_;
};

}  // namespace

std::string to_program(const Scene& scene) {
  return Program(scene).text();
}

}  // namespace cross
