// The little of OpenGL 3.3 that the window needs: programs, buffers, a colour table.
#pragma once

#include <epoxy/gl.h>

#include <palpate/core/types.hpp>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace live {

using namespace palpate;

/// A vertex and a fragment shader. Throws std::runtime_error with the compiler's message.
class Shader {
 public:
  Shader(const char* vertex, const char* fragment);
  ~Shader() { glDeleteProgram(program_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;

  void use() const { glUseProgram(program_); }
  void set(const char* name, const Eigen::Matrix4d& m) const;
  void set(const char* name, const Vector3& v) const;
  void set(const char* name, double value) const;

 private:
  int place(const char* name) const { return glGetUniformLocation(program_, name); }
  unsigned program_ = 0;
};

/// Triangles on the graphics card: positions, normals, one value per point.
class TriangleBuffer {
 public:
  TriangleBuffer();
  ~TriangleBuffer();
  TriangleBuffer(const TriangleBuffer&) = delete;
  TriangleBuffer& operator=(const TriangleBuffer&) = delete;

  void set_points(std::span<const float> positions, std::span<const float> normals, std::span<const float> values);
  void set_triangles(std::span<const std::array<int, 3>> triangles);
  void draw() const;

 private:
  void upload(unsigned attribute, int components, std::span<const float> numbers);
  unsigned array_ = 0;
  std::array<unsigned, 4> buffers_{};  // of the three attributes, and the triangles
  int indices_ = 0;
};

/// A row of colours as a texture.
class ColourTable {
 public:
  explicit ColourTable(std::span<const std::array<std::uint8_t, 3>> colours);
  ~ColourTable() { glDeleteTextures(1, &texture_); }
  ColourTable(const ColourTable&) = delete;
  ColourTable& operator=(const ColourTable&) = delete;
  void use() const { glBindTexture(GL_TEXTURE_2D, texture_); }

 private:
  unsigned texture_ = 0;
};

}  // namespace live
