// The functions of palpate_session.
#pragma once

#include <palpate/c/detail/handles.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/haptic/haptic_servo.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

namespace {

Vector3 vector_or(const double (&given)[3], const Vector3& otherwise) {
  const Vector3 v(given);
  return v.isZero(0.0) ? otherwise : v;
}

double value_or(double given, double otherwise) {
  return given == 0.0 ? otherwise : given;
}

Tool tool_from(const palpate_tool& t) {
  switch (t.kind) {
    case PALPATE_SPHERE:
      return SphereTool{value_or(t.radius, SphereTool{}.radius)};
    case PALPATE_CAPSULE:
      return CapsuleTool(value_or(t.radius, CapsuleTool{}.radius), t.half_length,
                         vector_or(t.axis, CapsuleTool{}.axis));
    case PALPATE_BLADE: {
      const BladeTool blade;
      return BladeTool{vector_or(t.edge, blade.edge), value_or(t.toughness, blade.toughness),
                       value_or(t.cut_spacing, blade.cut_spacing)};
    }
    default:
      refuse("there is no tool of kind " + std::to_string(t.kind));
  }
}

ToolList tools_from(const palpate_tool* tools, std::size_t count) {
  if (count == 0 || count > HapticServo::max_tools)
    refuse(std::to_string(count) + " tools", "A session has 1 to " + std::to_string(HapticServo::max_tools));
  if (tools == nullptr) refuse("tools is null");
  std::vector<Tool> list;
  const auto* next = reinterpret_cast<const unsigned char*>(tools);  // an older program has shorter entries
  for (std::size_t i = 0; i < count; ++i) {
    const palpate_tool t = read_struct(reinterpret_cast<const palpate_tool*>(next), "a tool");
    list.push_back(tool_from(t));
    next += t.struct_size;
  }
  return ToolList(list);
}

ServoOptions servo_options_from(const palpate_session_options& given) {
  ServoOptions options;
  DeviceLimits& device = options.devices.emplace_back();
  device.rate = value_or(given.rate, device.rate);
  device.peak_force = value_or(given.peak_force, device.peak_force);
  device.continuous_force = value_or(given.continuous_force, device.continuous_force);
  device.stiffness = value_or(given.stiffness, device.stiffness);
  device.peak_torque = given.peak_torque;
  device.rotational_stiffness = given.rotational_stiffness;
  options.contact.friction = given.friction;
  options.stale_tissue_after = value_or(given.stale_tissue_after, options.stale_tissue_after);
  options.corrected_force = given.corrected_force > 0;
  options.grasp_buttons = given.grasp_buttons;
  options.limit_energy = given.limit_energy != 0;
  return options;
}

ToolState state_from(const palpate_tool_state& given) noexcept {
  ToolState state;
  state.position = Vector3(given.position);
  if ((given.given & PALPATE_HAS_VELOCITY) != 0) state.velocity = Vector3(given.velocity);
  if ((given.given & PALPATE_HAS_ORIENTATION) != 0)
    for (std::size_t k = 0; k < 4; ++k) state.orientation[k] = given.orientation[k];
  state.time = given.time;
  if ((given.given & PALPATE_HAS_NOW) != 0) state.now = given.now;
  state.buttons = given.buttons;
  state.valid = (given.given & PALPATE_UNREADABLE) == 0;
  return state;
}

void write(const Vector3& v, double (&out)[3]) noexcept {
  out[0] = v[0];
  out[1] = v[1];
  out[2] = v[2];
}

/// Whether every entry is exactly of this version: structs of ticks have one layout.
template <class T>
bool are_exact(const T* entries, std::size_t count) noexcept {
  for (std::size_t i = 0; i < count; ++i)
    if (entries[i].struct_size != sizeof(T) || entries[i].interface_version != PALPATE_C_VERSION) return false;
  return true;
}

}  // namespace

/// A session claims its tissue for its lifetime.
class Claim {
 public:
  explicit Claim(std::shared_ptr<SharedTissue> shared) : shared_(std::move(shared)) {
    if (shared_->in_session.exchange(true))
      refuse("the tissue has a session already", "Destroy that session first; one session may have several tools");
  }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;
  ~Claim() { shared_->in_session.store(false); }
  AnyTissue& tissue() const noexcept { return *shared_->tissue; }

 private:
  std::shared_ptr<SharedTissue> shared_;
};

}}}  // namespace palpate::PALPATE_ABI::c_interface

struct palpate_session {
  static constexpr std::uint32_t kind = 0x73657373;
  palpate::c_interface::HandleTag tag{kind};
  palpate::c_interface::Claim claim;
  std::size_t tools;
  std::unique_ptr<palpate::HapticServo> servo;
  std::vector<palpate::ToolState> states;
  std::unique_ptr<palpate::c_interface::Skin> skin;
  std::vector<float> normals{};                         // where the caller wants none
  std::unique_ptr<palpate::BackgroundWorker> worker{};  // ends first

  palpate_session(std::shared_ptr<palpate::c_interface::SharedTissue> shared, const palpate::ToolList& list,
                  const palpate_session_options& options)
      : claim(std::move(shared)), tools(list.size()), states(list.size()) {
    servo = claim.tissue().make_servo(list, palpate::c_interface::servo_options_from(options));
    skin = claim.tissue().make_skin();
    normals.resize(3 * static_cast<std::size_t>(skin->point_count()));
    if (options.manual_work == 0) worker = claim.tissue().make_worker();
  }

  /// One tick of all tools; see palpate_session_tick.
  void tick(const palpate_tool_state* given, palpate_tool_force* out) noexcept {
    using namespace palpate::c_interface;
    for (std::size_t i = 0; i < tools; ++i) states[i] = state_from(given[i]);
    const std::span<const palpate::GatedForce> forces = servo->tick(states);
    const palpate::TickView view = servo->tick_view();
    const int rows = view.contact_rows();
    for (std::size_t i = 0; i < tools; ++i) {
      write(forces[i].force(), out[i].force);
      write(forces[i].torque(), out[i].torque);
      write(view.contact_force(i), out[i].contact_force);
      out[i].error_expected = forces[i].error.expected;
      out[i].error_bound = forces[i].error.bound;
      out[i].status = forces[i].status.bits();
      out[i].contacts = rows;
    }
  }
};

extern "C" {

palpate_error palpate_session_create(palpate_tissue* tissue, const palpate_tool* tools, size_t tool_count,
                                     const palpate_session_options* options, palpate_session** session) {
  using namespace palpate::c_interface;
  return guarded([&] {
    palpate_session*& out = target(session, "session");
    out = nullptr;
    palpate_session_options given{};
    if (options != nullptr) given = read_struct(options, "options");
    const palpate::ToolList list = tools_from(tools, tool_count);
    out = new palpate_session(object(tissue, "tissue").shared, list, given);
  });
}

palpate_error palpate_session_tick(palpate_session* session, const palpate_tool_state* states, size_t tick_count,
                                   palpate_tool_force* forces) {
  using namespace palpate::c_interface;
  if (session == nullptr || session->tag.value != palpate_session::kind)
    return store(PALPATE_INVALID_ARGUMENT, "session is null or of another kind");
  if (tick_count == 0) return PALPATE_OK;
  if (states == nullptr || forces == nullptr) return store(PALPATE_INVALID_ARGUMENT, "states or forces is null");
  const std::size_t tools = session->tools;
  if (!are_exact(states, tick_count * tools) || !are_exact(forces, tick_count * tools))
    return store(PALPATE_INVALID_ARGUMENT, "a state or force has a size or version that is not that of the library",
                 "Prepare every entry with PALPATE_INIT");
  const palpate::FlushDenormals flush;
  for (std::size_t i = 0; i < tick_count; ++i) session->tick(states + i * tools, forces + i * tools);
  return PALPATE_OK;
}

palpate_error palpate_session_reset(palpate_session* session) {
  using namespace palpate::c_interface;
  return guarded([&] { object(session, "session").servo->reset(); });
}

palpate_error palpate_session_work(palpate_session* session, int32_t* worked) {
  using namespace palpate::c_interface;
  return guarded([&] {
    palpate_session& s = object(session, "session");
    if (s.worker) s.worker->rethrow_failure();
    if (s.worker) refuse("a background thread does this work", "Set manual_work in palpate_session_options");
    const bool did = s.claim.tissue().work();
    if (worked != nullptr) *worked = did ? 1 : 0;
  });
}

palpate_error palpate_session_surface_size(const palpate_session* session, size_t* point_count,
                                           size_t* triangle_count) {
  using namespace palpate::c_interface;
  return guarded([&] {
    const palpate_session& s = object(session, "session");
    if (point_count != nullptr) *point_count = static_cast<size_t>(s.skin->point_count());
    if (triangle_count != nullptr) *triangle_count = s.skin->triangles().size();
  });
}

palpate_error palpate_session_triangles(const palpate_session* session, int32_t* points, size_t capacity) {
  using namespace palpate::c_interface;
  return guarded([&] {
    const auto& triangles = object(session, "session").skin->triangles();
    if (capacity < 3 * triangles.size())
      refuse("room for " + std::to_string(capacity) + " numbers; the triangles need " +
             std::to_string(3 * triangles.size()));
    std::int32_t* out = numbers(points, capacity, "points").data();
    for (const auto& triangle : triangles)
      for (const int point : triangle) *out++ = point;
  });
}

palpate_error palpate_session_read_surface(palpate_session* session, float* positions, float* normals,
                                           size_t capacity) {
  using namespace palpate::c_interface;
  return guarded([&] {
    palpate_session& s = object(session, "session");
    const std::size_t size = 3 * static_cast<std::size_t>(s.skin->point_count());
    if (capacity < size)
      refuse("room for " + std::to_string(capacity) + " numbers; the points need " + std::to_string(size));
    const std::span<float> x = numbers(positions, size, "positions");
    const std::span<float> n = normals == nullptr ? std::span<float>(s.normals) : std::span<float>(normals, size);
    if (!s.skin->read(s.servo->read_snapshot().vertex_forces(), x, n))
      refuse("the tissue has changed since the surface was updated", "Call palpate_session_update_surface");
  });
}

palpate_error palpate_session_update_surface(palpate_session* session, int32_t* changed) {
  using namespace palpate::c_interface;
  return guarded([&] {
    palpate_session& s = object(session, "session");
    const bool is_new = s.skin->update();
    if (is_new) s.normals.resize(3 * static_cast<std::size_t>(s.skin->point_count()));
    if (changed != nullptr) *changed = is_new ? 1 : 0;
  });
}

palpate_error palpate_session_snapshot(palpate_session* session, palpate_snapshot* snapshot) {
  using namespace palpate::c_interface;
  return guarded([&] {
    palpate_session& s = object(session, "session");
    const palpate::ServoSnapshot& newest = s.servo->read_snapshot();
    palpate_snapshot out{};
    out.time = newest.time;
    out.tool_count = static_cast<std::int32_t>(newest.tool_count);
    out.contact_count = static_cast<std::int32_t>(newest.contact_count);
    for (std::size_t i = 0; i < newest.tool_count; ++i) {
      const palpate::Vector3 force = newest.contact_force(i);
      std::copy_n(newest.proxies[i].data(), 3, out.proxies + 3 * i);
      std::copy_n(force.data(), 3, out.contact_forces + 3 * i);
    }
    if (!write_struct(&target(snapshot, "snapshot"), out))
      refuse("the snapshot has an unknown size or version", "Prepare it with PALPATE_INIT");
  });
}

void palpate_session_destroy(palpate_session* session) {
  if (session == nullptr || session->tag.value != palpate_session::kind) return;
  session->tag.value = 0;
  session->worker.reset();
  session->servo->release();
  delete session;
}

}  // extern "C"
