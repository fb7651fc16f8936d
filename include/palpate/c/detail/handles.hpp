// What the handles of the C interface point to.
#pragma once

#include <palpate/c/detail/any_tissue.hpp>
#include <palpate/c/detail/given_mesh.hpp>
#include <palpate/c/detail/structs.hpp>
#include <palpate/mesh/scene.hpp>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

/// `tag` is the first member, and zero after destruction.
struct palpate_mesh {
  static constexpr std::uint32_t kind = 0x6d657368;
  palpate::c_interface::HandleTag tag{kind};
  palpate::c_interface::GivenMesh given{};
};

struct palpate_scene {
  static constexpr std::uint32_t kind = 0x7363656e;
  palpate::c_interface::HandleTag tag{kind};
  palpate::Scene scene{};
};

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// A tissue, shared by its handle and its session.
struct SharedTissue {
  std::string policy;
  std::unique_ptr<AnyTissue> tissue;
  std::atomic<bool> in_session{false};
};

}}}  // namespace palpate::PALPATE_ABI::c_interface

struct palpate_tissue {
  static constexpr std::uint32_t kind = 0x74697373;
  palpate::c_interface::HandleTag tag{kind};
  std::shared_ptr<palpate::c_interface::SharedTissue> shared{};
};
