// A scene of the cross tests: everything that the force on a tool depends on, as one value.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace cross {

/// A tool and its path. A place is given by two numbers in 0 ... 1 on the touchable part of the body (bodies.hpp).
struct ToolValue {
  std::string kind = "sphere";  ///< sphere, capsule, plate, blade
  double radius = 6e-3;         ///< [m]; of a plate and a blade: half of their length is two radii
  bool grasps = false;          ///< from the deepest point of the path on
  std::string path = "press";   ///< press, hold, slide, twist, leap, lost, frozen
  double u = 0.5, v = 0.5;      ///< place
  double depth = 0.25;          ///< deepest, in radii; of a blade: [edge lengths of the body]
  double travel = 0.0;          ///< along the surface during a slide, in radii
  bool opposite = false;        ///< from the opposite side, where the body has one that can be touched: a pinch

  bool operator==(const ToolValue&) const = default;
};

/// Lengths in metres; the defaults are the plainest scene. Words that are allowed: scene.cpp.
struct Scene {
  // Body
  std::string body = "block";                 ///< block, plate, lobe, dome, tube, sphere, organ
  double edge = 6e-3;                         ///< length of a cell [m]
  int cells_x = 6, cells_y = 6, cells_z = 3;  ///< of sphere and organ: the first is the number of layers
  double jitter = 0.0;                        ///< of nodes inside, in edges
  int slivers = 0;                            ///< tetrahedra made almost flat
  std::string regions = "one";                ///< one, layer, half, inclusion
  double contrast = 1.0;                      ///< Young's modulus of the second region, relative
  std::string touched = "top";                ///< top, surface (without the support), whole (with it)
  std::string support = "bottom";             ///< bottom, sides, end
  // Tissue
  std::string element = "tet4", law = "linear", solver = "condensed";  ///< words of compositions.hpp
  double youngs_modulus = 5e3, poisson_ratio = 0.4, density = 1000.0;
  // Loads
  std::string load = "none";     ///< none, gravity, pressure, traction, body, point, swelling
  double load_size = 0.0;        ///< strain that the load causes, roughly
  double support_moves = 0.0;    ///< displacement of the support across the body, in edges
  double support_travels = 0.0;  ///< of a box on two sides: what one of them goes away and comes back, in lengths of it
  // Contact
  double friction = 0.0;
  double coupling = 1000.0;  ///< stiffness [N/m]
  int capacity = 0;          ///< of contacts; 0: the default
  bool measured = false;     ///< the error of forces is measured at set-up
  bool corrected = false;    ///< the same, and ServoOptions::corrected_force
  // How it runs
  int rate = 1000;  ///< ticks per second
  int ticks = 300;
  int threads = 1;
  double step = 0.01;             ///< of moving tissue [s]
  bool inertia = true;            ///< of tissue on quasi_newton
  std::string pose = "identity";  ///< identity, rotated
  std::string member = "alone";   ///< alone, group, pair, adaptor
  int cuts = 0;                   ///< orders of cuts beside the blade's, at even times
  std::vector<ToolValue> tools{ToolValue{}};
  std::uint64_t seed = 1;  ///< of jitter and slivers

  bool operator==(const Scene&) const = default;
};

/// Calls f(name, value) for every value of a tool, and of a scene except its tools; f takes std::string&, double&,
/// int&, bool& and std::uint64_t&, constant for a constant scene.
template <class Tool, class F>
void visit_tool(Tool& t, F&& f) {
  f("kind", t.kind), f("radius", t.radius), f("grasps", t.grasps), f("path", t.path), f("u", t.u), f("v", t.v);
  f("depth", t.depth), f("travel", t.travel), f("opposite", t.opposite);
}
template <class Value, class F>
void visit(Value& s, F&& f) {
  f("body", s.body), f("edge", s.edge), f("cells_x", s.cells_x), f("cells_y", s.cells_y), f("cells_z", s.cells_z);
  f("jitter", s.jitter), f("slivers", s.slivers), f("regions", s.regions), f("contrast", s.contrast);
  f("touched", s.touched), f("support", s.support);
  f("element", s.element), f("law", s.law), f("solver", s.solver);
  f("youngs_modulus", s.youngs_modulus), f("poisson_ratio", s.poisson_ratio), f("density", s.density);
  f("load", s.load), f("load_size", s.load_size), f("support_moves", s.support_moves);
  f("support_travels", s.support_travels);
  f("friction", s.friction), f("coupling", s.coupling), f("capacity", s.capacity), f("measured", s.measured),
      f("corrected", s.corrected);
  f("rate", s.rate), f("ticks", s.ticks), f("threads", s.threads), f("step", s.step), f("inertia", s.inertia);
  f("pose", s.pose), f("member", s.member), f("cuts", s.cuts), f("seed", s.seed);
}

/// Whether a blade or an order cuts the body.
bool is_cut(const Scene& scene);

/// The words that a value may have, such as the kinds of bodies; empty for a number.
const std::vector<std::string>& words_of(std::string_view name);

/// One line per value that differs from the plainest scene: "name value", "tool 0 name value". Numbers are exact.
std::string to_text(const Scene& scene);
/// The reverse. Lines that start with # are comments. Throws std::runtime_error with the line for an unknown name, a
/// word that does not exist, or a number that cannot be read.
Scene from_text(std::istream& in);

}  // namespace cross
