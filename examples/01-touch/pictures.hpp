// Converts the record of a session to pictures (positions, stress, the tool) and to a series for ParaView.
#pragma once

#include "chart.hpp"
#include "session.hpp"

#include <palpate/device/recorder.hpp>
#include <palpate/io/vtu.hpp>
#include <palpate/io/pvd.hpp>
#include <palpate/post/colour_map.hpp>
#include <palpate/post/stress.hpp>

#include <filesystem>

namespace touch {

/// A frame and the quantities computed from it.
struct Picture {
  double time = 0.0;
  Vector3 hand, sphere,
      force;                   ///< world frame: device, sphere on the surface [m]; force on the sphere [N]
  double penetration = 0.0;    ///< of the device into the surface at rest [m]; negative: above it
  VectorX displacement;        ///< 3 per node [m]
  VectorX von_mises;           ///< per node [Pa]
  VectorX von_mises_elements;  ///< per element [Pa]
};

/// Penetration of a sphere at `position` into the surface at rest [m].
inline double penetration(const Organ& organ, const Vector3& position) {
  return tool.radius - organ.contact_surface().closest(organ.to_world().inverse() * position).distance;
}

inline std::vector<Picture> develop(const Organ& organ, const Recording& session) {
  std::vector<Picture> pictures;
  StressField stress;
  for (const Frame& frame : session.frames) {
    recover_stress(organ.body(), frame.displacement, stress);
    const auto tick =
        std::ranges::lower_bound(session.ticks, frame.time, {}, [](const RecordedTick& t) { return t.state.time; });
    if (tick == session.ticks.end()) continue;
    const Vector3 hand = tick->state.position;
    // Hand and sphere are coupled by a spring of the device's stiffness: in contact their positions differ.
    const Vector3 sphere = hand + frame.force / DeviceLimits{}.stiffness;
    pictures.push_back({frame.time, hand, sphere, frame.force, penetration(organ, hand), frame.displacement,
                        stress.von_mises_nodes, stress.von_mises_elements});
  }
  return pictures;
}

/// The surface of one region, outward, in node ids.
inline std::vector<std::array<NodeId, 3>> region_surface(const Organ& organ, std::string_view name) {
  Mesh<Tet4> part;
  part.positions = organ.mesh().positions;
  for (Index e = 0; e < organ.mesh().element_count(); ++e)
    if (organ.mesh().region_name(organ.mesh().region(e)) == name)
      part.elements.push_back(organ.mesh().elements[static_cast<std::size_t>(e)]);
  std::vector<std::array<NodeId, 3>> faces;
  for (const auto& face : extract_boundary<Tet4>(part)) faces.push_back({face.nodes[0], face.nodes[1], face.nodes[2]});
  return faces;
}

/// About 50 files for ParaView, evenly spaced in time, and the list of them. Returns their number.
inline Index write_series(const std::filesystem::path& folder, const Organ& organ,
                          const std::vector<Picture>& pictures) {
  std::filesystem::create_directories(folder / "vtu");
  io::PvdSeries series((folder / "touch.pvd").string());
  const std::size_t step = std::max<std::size_t>(1, (pictures.size() + 25) / 50);
  for (std::size_t i = 0; i < pictures.size(); i += step) {
    const std::string file = (folder / "vtu" / text("touch_%03d.vtu", static_cast<int>(i / step))).string();
    io::VtuFields fields;
    fields.at_nodes = {{"displacement [m]", pictures[i].displacement}, {"von Mises [Pa]", pictures[i].von_mises}};
    fields.at_elements = {{"von Mises mean [Pa]", pictures[i].von_mises_elements}};
    io::write_vtu(file, organ.mesh(), fields);
    series.add(pictures[i].time, file);
  }
  return series.size();
}

}  // namespace touch
