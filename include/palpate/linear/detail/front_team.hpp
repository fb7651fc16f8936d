// Threads that share the work on one front.
#pragma once

#include <palpate/core/types.hpp>

namespace palpate {

// The same type for all compiler flags: kernels for other processors (front_job.hpp) use it too.
namespace any_flags {

/// Distributes independent pieces of work.
class FrontTeam {
 public:
  /// Calls piece(0) ... piece(count - 1), each once or, after a cancellation, not at all, and returns when all have
  /// returned.
  template <class Piece>
  void each(std::int64_t count, Piece& piece) noexcept {
    run(count, &piece, [](void* p, std::int64_t i) { (*static_cast<Piece*>(p))(i); });
  }

 protected:
  ~FrontTeam() = default;

 private:
  virtual void run(std::int64_t count, void* piece, void (*call)(void*, std::int64_t)) noexcept = 0;
};

}  // namespace any_flags

inline namespace PALPATE_ABI { namespace detail {

using any_flags::FrontTeam;

/// The same, in the calling thread when there is no team.
template <class Piece>
inline void share(FrontTeam* team, Index count, Piece&& piece) noexcept {
  if (team != nullptr) return team->each(count, piece);
  for (Index i = 0; i < count; ++i) piece(i);
}

}}
}  // namespace palpate::detail
