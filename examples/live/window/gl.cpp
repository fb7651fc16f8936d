#include "gl.hpp"

#include <stdexcept>

namespace live {

namespace {

unsigned compile(unsigned kind, const char* source) {
  const unsigned shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  int done = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done == GL_TRUE) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, static_cast<int>(log.size()), nullptr, log.data());
  throw std::runtime_error(std::string("a shader does not compile: ") + log.data());
}

}  // namespace

Shader::Shader(const char* vertex, const char* fragment) : program_(glCreateProgram()) {
  const std::array parts{compile(GL_VERTEX_SHADER, vertex), compile(GL_FRAGMENT_SHADER, fragment)};
  for (const unsigned part : parts) glAttachShader(program_, part);
  glLinkProgram(program_);
  for (const unsigned part : parts) glDeleteShader(part);
  int done = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &done);
  if (done != GL_TRUE) throw std::runtime_error("the shaders do not link");
}

void Shader::set(const char* name, const Eigen::Matrix4d& m) const {
  const Eigen::Matrix4f single = m.cast<float>();
  glUniformMatrix4fv(place(name), 1, GL_FALSE, single.data());
}
void Shader::set(const char* name, const Vector3& v) const {
  const Eigen::Vector3f single = v.cast<float>();
  glUniform3fv(place(name), 1, single.data());
}
void Shader::set(const char* name, double value) const {
  glUniform1f(place(name), static_cast<float>(value));
}

TriangleBuffer::TriangleBuffer() {
  glGenVertexArrays(1, &array_);
  glGenBuffers(static_cast<int>(buffers_.size()), buffers_.data());
}
TriangleBuffer::~TriangleBuffer() {
  glDeleteBuffers(static_cast<int>(buffers_.size()), buffers_.data());
  glDeleteVertexArrays(1, &array_);
}

void TriangleBuffer::upload(unsigned attribute, int components, std::span<const float> numbers) {
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[attribute]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(numbers.size_bytes()), numbers.data(), GL_STREAM_DRAW);
  glEnableVertexAttribArray(attribute);
  glVertexAttribPointer(attribute, components, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void TriangleBuffer::set_points(std::span<const float> positions, std::span<const float> normals,
                                std::span<const float> values) {
  glBindVertexArray(array_);
  upload(0, 3, positions);
  upload(1, 3, normals);
  upload(2, 1, values);
}

void TriangleBuffer::set_triangles(std::span<const std::array<int, 3>> triangles) {
  glBindVertexArray(array_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[3]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size_bytes()), triangles.data(),
               GL_DYNAMIC_DRAW);
  indices_ = static_cast<int>(3 * triangles.size());
}

void TriangleBuffer::draw() const {
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr);
}

ColourTable::ColourTable(std::span<const std::array<std::uint8_t, 3>> colours) {
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, static_cast<int>(colours.size()), 1, 0, GL_RGB, GL_UNSIGNED_BYTE,
               colours.data());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

}  // namespace live
