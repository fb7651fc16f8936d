// Threads that share the work on one front.
#pragma once

#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Distributes independent pieces of work.
class FrontTeam {
 public:
  /// Calls piece(0) ... piece(count - 1), each once or, after a cancellation, not at all, and returns when all have
  /// returned.
  template <class Piece>
  void each(Index count, Piece& piece) noexcept {
    run(count, &piece, [](void* p, Index i) { (*static_cast<Piece*>(p))(i); });
  }

 protected:
  ~FrontTeam() = default;

 private:
  virtual void run(Index count, void* piece, void (*call)(void*, Index)) noexcept = 0;
};

/// The same, in the calling thread when there is no team.
template <class Piece>
inline void share(FrontTeam* team, Index count, Piece&& piece) noexcept {
  if (team != nullptr) return team->each(count, piece);
  for (Index i = 0; i < count; ++i) piece(i);
}

}}}  // namespace palpate::detail
