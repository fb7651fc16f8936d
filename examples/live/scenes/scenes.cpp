#include "scenes.hpp"

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/surface.hpp>

namespace live {

namespace {

struct NamedScene {
  const char* name;
  TouchScene (*make)();
};
constexpr NamedScene all[] = {{"palpate", palpate_scene},
                              {"retract", retract_scene},
                              {"grasp", grasp_scene},
                              {"cut", cut_scene},
                              {"beating", beating_scene}};

}  // namespace

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NamedScene& s : all) list.emplace_back(s.name);
    return list;
  }();
  return names;
}

TouchScene make_scene(const std::string& name) {
  for (const NamedScene& s : all)
    if (name == s.name) return s.make();
  raise(SetupErrorKind::bad_argument, "there is no scene \"" + name + "\"",
        "Give palpate, retract, grasp, cut or beating");
}

std::vector<NodeId> facing_down(const Mesh<Tet4>& mesh) {
  std::vector<NodeId> nodes;
  for (const auto& face : extract_boundary<Tet4>(mesh)) {
    const Vector3 a = mesh.position(face.nodes[0]), b = mesh.position(face.nodes[1]), c = mesh.position(face.nodes[2]);
    if ((b - a).cross(c - a).normalized().z() < -0.5) nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
  }
  return nodes;
}

}  // namespace live
