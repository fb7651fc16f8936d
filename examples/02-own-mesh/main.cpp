// Example 02: your own mesh.
//
//   example_02_own_mesh [FILE] [--scale METRES] [--labels ARRAY] [--fix GROUP] [--touch GROUP] [--radius METRES]
//                       [--largest-piece] [--out DIR]
//
// Reads a mesh file, reports its defects and what to do about them, and touches the body with a scripted sphere.
// Without a file it uses the organ shipped with palpate. docs/from_images.md describes how to make such a file from a
// scan.
//
//   1. Read. The format is detected from the content of the file. Positions are converted to metres: --scale 1e-3 for a
//      file in millimetres, the unit of most scans. A file without solids is refused; the message contains the command
//      that meshes it.
//   2. Diagnose. `diagnose` measures and refuses nothing: sizes, quality, inverted and flat elements, duplicates,
//      orphans, disconnected pieces. Read its output before you look for an error elsewhere.
//   3. Define the supports of the body and its touchable part, by names of groups, by position or by lists of nodes
//      (scene.hpp in this folder).
//   4. Set up. HapticFEModel refuses invalid input. Every refusal has a kind; `advice` states what to do about the most
//      common ones. Nothing is repaired silently: repairs must be requested with AdmissionPolicy.
//   5. Touch, and write the result for ParaView: DIR/touched.vtu, with displacement and stress.
//
// The exit code is 0 when the sphere was pressed in and the force was not zero, 1 when it was zero, 2 when the mesh or
// the arguments were refused.
#include "scene.hpp"

#include <palpate/io/vtu.hpp>
#include <palpate/mesh/diagnose.hpp>
#include <palpate/post/stress.hpp>
#if OWN_MESH_XML
#include <palpate/io/xml/read_mesh.hpp>
#endif

#include <filesystem>
#include <iostream>

using namespace own_mesh;

namespace {

using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

std::optional<Arguments> read_arguments(int count, char** values) {
  Arguments a;
  for (int i = 1; i < count; ++i) {
    const std::string_view name = values[i];
    if (!name.starts_with("--")) {
      a.file = name;
      continue;
    }
    if (name == "--largest-piece") {
      a.largest_piece = true;
      continue;
    }
    if (++i == count) return {};
    const auto positive = [&](double& x) { return io::parse_decimal(values[i], x) == std::errc{} && x > 0.0; };
    if (name == "--fix")
      a.fix = values[i];
    else if (name == "--touch")
      a.touch = values[i];
    else if (name == "--out")
      a.out = values[i];
    else if (name == "--labels")
      a.labels = values[i];
    else if (!(name == "--scale" && positive(a.scale)) && !(name == "--radius" && positive(a.radius)))
      return {};
  }
  return a;
}

/// What to do about a refusal, for the most common kinds.
const char* advice(SetupErrorKind kind) {
  switch (kind) {
    case SetupErrorKind::inverted_element:
      return "If all elements are inverted, the file uses the opposite node order: set\n"
             "SetupOptions::admission.inverted = Admission::repair. If only some are, mesh again.";
    case SetupErrorKind::degenerate_element:
    case SetupErrorKind::poor_quality:
      return "Smooth the surface and mesh again (gmsh -optimize, tetgen -pq1.2); dropping flat elements with\n"
             "admission.degenerate = Admission::repair may leave holes.";
    case SetupErrorKind::duplicate_node:
      return "Parts that were meshed separately share no nodes. If they should be connected:\n"
             "admission.duplicate_nodes = Admission::repair welds them.";
    case SetupErrorKind::unconstrained:
      return "Fix at least three nodes of every piece that are not on one line: --fix with a group. If the mesh has\n"
             "several pieces, --largest-piece keeps the largest only: SetupOptions::admission.disconnected = "
             "Admission::repair.";
    case SetupErrorKind::unknown_group:
    case SetupErrorKind::empty_group:
      return "Name one of the groups listed above, or leave --fix and --touch out.";
    case SetupErrorKind::unsupported:
      return "This program reads tetrahedra. In yours, a file of hexahedra needs read_mesh<Hex8>, one of ten-node\n"
             "tetrahedra read_mesh<Tet10>.";
    case SetupErrorKind::bad_file:
      return "The message names the line, what was expected there and what was found: check it in the file.";
    default:
      return "docs/errors.md lists every kind of refusal.";
  }
}

Mesh<Tet4> read(const Arguments& arguments) {
#if OWN_MESH_XML  // pugixml and zlib are installed: also VTU and FEBio
  return io::xml::read_mesh<Tet4>(arguments.file, {.scale = arguments.scale, .labels = arguments.labels});
#else
  return io::read_mesh<Tet4>(arguments.file, {.scale = arguments.scale, .labels = arguments.labels});
#endif
}

/// The size in millimetres, in which a wrong unit is seen at once, and the corners of the box [m].
void print_size(const MeshDiagnosis& d) {
  const Vector3 size = 1e3 * (d.box_max - d.box_min);
  std::printf("size: %.3g x %.3g x %.3g mm, from %s to %s m\n", size.x(), size.y(), size.z(),
              code_of(d.box_min).c_str(), code_of(d.box_max).c_str());
}

/// What this program did, to paste into another.
void print_code(const Chosen& chosen, const Press& press) {
  std::printf("the same as code:\n  %s\n", chosen.code.c_str());
  std::printf("  MockDevice finger(trajectory::poke({.from = %s, .to = %s}));\n", code_of(press.above).c_str(),
              code_of(press.deepest).c_str());
  std::printf("  const SphereTool sphere{.radius = %.4g};\n", press.sphere.radius);
}

void print_groups(const Mesh<Tet4>& mesh) {
  std::cout << "groups:\n";
  for (const Group& g : mesh.groups.all())
    std::cout << "  '" << g.name << "': " << g.nodes.size() << " nodes, " << g.faces.size() << " faces, "
              << g.elements.size() << " elements\n";
  if (mesh.groups.all().empty()) std::cout << "  none\n";
}

/// Histogram of element quality, as bars.
void print_quality(const MeshDiagnosis& d) {
  std::cout << "quality (mean ratio, 1 is regular; below " << MeshThresholds{}.poor_quality << " is poor):\n";
  const Index most = *std::ranges::max_element(d.quality_histogram);
  for (std::size_t i = 0; i < d.quality_histogram.size(); ++i) {
    const Index n = d.quality_histogram[i];
    const auto bar = static_cast<std::size_t>(most > 0 ? (40 * n + most - 1) / most : 0);
    std::printf("  %.1f-%.1f %8lld %s\n", 0.1 * static_cast<double>(i), 0.1 * static_cast<double>(i + 1),
                static_cast<long long>(n), std::string(bar, '#').c_str());
  }
}

/// Presses the sphere in, unpaced. Returns the largest force [N] and stores the displacement at the deepest moment in
/// `u`.
double touch(Organ& organ, const Press& press, VectorX& u) {
  MockDevice stylus(trajectory::poke({.from = press.above, .to = press.deepest, .approach = 0.5, .hold = 0.2}));
  HapticSession session(stylus, organ, press.sphere);
  const LoopReport report = session.run({.duration = 0.7, .paced = false});
  u.resize(3 * organ.mesh().node_count());
  organ.displacement_with(session.snapshot(), u);
  std::cout << "touched with a sphere of " << 1e3 * press.sphere.radius << " mm, " << 1e3 * press.depth
            << " mm deep: " << report.peak_force << " N, status " << report.status << '\n';
  return report.peak_force;
}

int run(const Arguments& arguments) {
  const Mesh<Tet4> mesh = read(arguments);
  std::cout << arguments.file << '\n';
  print_groups(mesh);
  const MeshDiagnosis diagnosis = diagnose<Tet4>(mesh);
  print_size(diagnosis);
  std::cout << describe(diagnosis) << '\n';
  print_quality(diagnosis);

  const Chosen chosen = choose(mesh, diagnosis, arguments);
  std::cout << "supports: " << chosen.constrained << "; touched: " << chosen.touched << '\n';
  SetupOptions options;
  if (arguments.largest_piece) options.admission.disconnected = Admission::repair;
  Organ organ(mesh, chosen.scene, {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}, options);
  std::cout << organ.report();

  const Press press = plan_press(organ, arguments.radius);
  VectorX u;
  const double force = touch(organ, press, u);
  print_code(chosen, press);
  StressField stress;
  recover_stress(organ.body(), u, stress);
  std::filesystem::create_directories(arguments.out);
  const std::string file = (std::filesystem::path(arguments.out) / "touched.vtu").string();
  io::write_vtu(file, organ.mesh(),
                {{{"displacement [m]", u}, {"von Mises [Pa]", stress.von_mises_nodes}},
                 {{"von Mises mean [Pa]", stress.von_mises_elements}}});
  std::cout << "wrote " << file << ", largest displacement " << 1e3 * u.cwiseAbs().maxCoeff() << " mm\n";
  return force > 0.0 && u.allFinite() ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  const auto arguments = read_arguments(count, values);
  if (!arguments) {
    std::cerr << "usage: example_02_own_mesh [FILE] [--scale METRES] [--labels ARRAY] [--fix GROUP] [--touch GROUP] "
                 "[--radius METRES] [--largest-piece] [--out DIR]\n";
    return 2;
  }
  try {
    return run(*arguments);
  } catch (const SetupError& error) {
    std::cerr << "refused: " << error.what() << "\n" << advice(error.kind()) << '\n';
    return 2;
  }
}
