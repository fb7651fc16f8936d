// The picture of the organ, the tools and the forces.
#pragma once

#include "../core/stage.hpp"
#include "gl.hpp"

namespace live {

/// What of a stage is drawn.
struct PictureOptions {
  double low = 0.0, high = 1.0;  ///< range of the colours, in the unit of the field
  bool reveal = false;           ///< the hidden region shows through
  bool forces = true;            ///< arrows
};

class Picture {
 public:
  static constexpr double arrow = 0.035;  ///< [m/N]

  Picture();
  void draw(Stage& stage, const PictureOptions& options);

 private:
  struct Paint {
    Vector3 colour;
    double alpha = 1.0, gloss = 0.25;
  };
  void draw_sky() const;
  void draw_floor(const DrawnSurface& surface);
  void draw_organ(Stage& stage, const DrawnSurface& surface, const PictureOptions& options);
  void draw_tool(Stage& stage, std::size_t tool);
  void draw_forces(const ServoSnapshot& snapshot);
  void draw_arrow(const Vector3& from, const Vector3& force, double radius, const Paint& paint);
  void draw_spring(const Vector3& from, const Vector3& to);
  void paint(const TriangleBuffer& shape, const Eigen::Matrix4d& model, const Paint& paint);

  Shader lit_, sky_, shadow_;
  ColourTable table_;
  TriangleBuffer organ_, hidden_, sphere_, cylinder_, cone_, box_, floor_;
  unsigned empty_array_ = 0;
  const Organ* shown_ = nullptr;
  unsigned long revision_ = 0;
};

}  // namespace live
