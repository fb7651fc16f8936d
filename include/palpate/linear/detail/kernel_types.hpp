// Types of the dense kernels of the sparse solver, and the threads that share the work on one front.
#pragma once

#include <palpate/core/types.hpp>

#include <array>
#include <cstdint>

namespace palpate {

// The same types for all compiler flags: the kernels may be compiled with other flags than their callers.
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

/// The dense part of the elimination of a front. Arrays have the layout of LowerPanels.
struct FrontJob {
  double* front;              ///< pivot columns; overwritten by those of the factor
  std::int64_t pivots, rows;  ///< rows: without those of the pivots
  double* update;             ///< lower triangle of the other rows; becomes -L21 L21^T
  std::int64_t place;         ///< of the first pivot in the elimination order
  double* pivot_values;       ///< per place; written
  const double* diagonal;     ///< of the matrix, per place
  double threshold;           ///< of pivots, relative to the diagonal
  double* packed;             ///< workspace
  FrontTeam* team;            ///< null: the calling thread does everything
};

/// How a column-major array is read as an operand; `symmetric` reads only the lower half.
enum class Read : unsigned char { plain, transposed, symmetric };

struct Operand {
  const double* data;
  std::int64_t stride;  ///< distance between columns in memory
  Read read = Read::plain;
};

/// A block of a column-major matrix; with `lower` only its lower half is written.
struct Target {
  double* data;
  std::int64_t rows, columns, stride;
  bool lower = false;
};

/// c = c + factor a b, where a has `depth` columns.
struct ProductJob {
  Target c;
  double factor;
  Operand a, b;
  std::int64_t depth;
  double* packed;  ///< workspace of product_workspace(c, depth) doubles
};

/// Substitution with the pivot columns `l` of a front, of the given height, for a block of right-hand sides x.
using BlockSubstitution = void (*)(const double* l, std::int64_t height, std::int64_t columns, double* x) noexcept;

/// Columns in one pass: the sum is loaded and stored once for all of them.
inline constexpr int columns_at_once = 8;
/// x += column k times load k, in double, for eight columns of n rows.
using FloatColumns = void (*)(const float* const* columns, const double* loads, std::int64_t n, double* x) noexcept;

/// Kernels compiled with the same flags.
struct Kernels {
  void (*factor_front)(const FrontJob&) noexcept;
  void (*add_product)(const ProductJob&) noexcept;
  std::int64_t packet_size;                            ///< doubles per register
  std::array<BlockSubstitution, 3> forward, backward;  ///< for blocks of one, two and three packets
  FloatColumns add_float_columns;
};

// Defined in palpate::compiled, each in a source of its own (cmake/compiled.cmake).
extern const Kernels kernels_avx2, kernels_avx512;

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
