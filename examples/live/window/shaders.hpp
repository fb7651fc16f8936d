// The shaders of the picture.
#pragma once

namespace live::shaders {

/// Lit surfaces: a key light over the shoulder of the viewer, light from the sky and from the floor, a highlight and a
/// bright rim. Colours are sRGB and mixed in linear light.
inline constexpr const char* lit_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float value;
uniform mat4 model, view_projection;
out vec3 at, n;
out float v;
void main() {
  vec4 world = model * vec4(position, 1.0);
  at = world.xyz;
  n = transpose(inverse(mat3(model))) * normal;
  v = value;
  gl_Position = view_projection * world;
})";

inline constexpr const char* lit_fragment = R"(#version 330 core
in vec3 at, n;
in float v;
out vec4 colour;
uniform vec3 eye, key, base;
uniform float low, high, use_table, alpha, gloss;
uniform sampler2D table;
void main() {
  vec3 albedo = base;
  if (use_table > 0.5) albedo = texture(table, vec2(clamp((v - low) / (high - low), 0.002, 0.998), 0.5)).rgb;
  if (use_table > 0.5 && v < -0.5) albedo = vec3(0.62, 0.07, 0.09);  // a wound
  albedo = pow(albedo, vec3(2.2));
  vec3 to_eye = normalize(eye - at), normal = normalize(n);
  if (!gl_FrontFacing) normal = -normal;
  float lambert = max(0.0, 0.75 * dot(normal, key) + 0.25);
  float sky = 0.5 + 0.5 * normal.z;
  vec3 light = vec3(1.0, 0.97, 0.93) * lambert * 0.62 + mix(vec3(0.16, 0.13, 0.14), vec3(0.30, 0.33, 0.38), sky);
  float highlight = pow(max(0.0, dot(normal, normalize(key + to_eye))), 48.0) * gloss;
  float rim = pow(1.0 - max(0.0, dot(normal, to_eye)), 4.0) * 0.10;
  vec3 lit = albedo * light + vec3(highlight + rim);
  colour = vec4(pow(clamp(lit, 0.0, 1.0), vec3(1.0 / 2.2)), alpha);
})";

/// The background: two colours from top to bottom.
inline constexpr const char* sky_vertex = R"(#version 330 core
out float height;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  height = corner.y;
  gl_Position = vec4(corner, 0.9999, 1.0);
})";
inline constexpr const char* sky_fragment = R"(#version 330 core
in float height;
out vec4 colour;
void main() {
  colour = vec4(mix(vec3(0.78, 0.81, 0.85), vec3(0.955, 0.965, 0.975), smoothstep(-1.0, 1.0, height)), 1.0);
})";

/// The soft shadow on the floor.
inline constexpr const char* shadow_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 model, view_projection;
out vec2 place;
void main() {
  place = position.xy;
  gl_Position = view_projection * model * vec4(position, 1.0);
})";
inline constexpr const char* shadow_fragment = R"(#version 330 core
in vec2 place;
out vec4 colour;
void main() {
  float near = 1.0 - smoothstep(0.35, 1.0, length(place));
  colour = vec4(0.10, 0.12, 0.17, 0.38 * near);
})";

}  // namespace live::shaders
