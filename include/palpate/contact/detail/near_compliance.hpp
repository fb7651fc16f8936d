// The compliance near the contacts, ready for a tick.
#pragma once

#include <palpate/concepts/vertex_force.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// C_ij for the vertices i near the tools and the vertices j that carry contacts. The stepping thread evaluates it when
/// it publishes a surface, so that a tick reads 72 bytes where it would rotate and correct a block of a large table.
class NearCompliance {
 public:
  NearCompliance() = default;
  /// For a surface of `vertices`, at most that many rows and columns. The only allocation.
  NearCompliance(std::size_t vertices, std::size_t rows, std::size_t columns)
      : rows_{vertices, rows}, columns_{vertices, columns}, block_(room()) {}

  /// For a surface of another number of vertices; nothing is known until `set`. Allocates only where it needs more.
  void resize(std::size_t vertices, std::size_t rows, std::size_t columns) {
    rows_.resize(vertices, rows);
    columns_.resize(vertices, columns);
    if (room() > block_.size()) block_.resize(room());
  }

  /// Memory of the blocks of such an object.
  static double bytes(std::size_t vertices, std::size_t rows, std::size_t columns) noexcept {
    return static_cast<double>(std::min(vertices, rows) * std::min(vertices, columns) * sizeof(Matrix3));
  }

  /// Sets C_ij = evaluate(i, j) for the vertices of both lists, each listed once; those beyond the largest numbers are
  /// left out. O(rows x columns), no allocation.
  template <class Evaluate>
  void set(std::span<const int> rows, std::span<const int> columns, Evaluate&& evaluate) noexcept {
    rows_.set(rows);
    columns_.set(columns);
    for (std::size_t i = 0; i < rows_.count; ++i)
      for (std::size_t j = 0; j < columns_.count; ++j)
        block_[i * columns_.most + j] = evaluate(rows_.listed[i], columns_.listed[j]);
  }

  /// Adds C_ij f_j to `sum` for the forces whose blocks are known, and calls unknown(force) for the others.
  template <class Unknown>
  void multiply(int i, std::span<const VertexForce> forces, Vector3& sum, Unknown&& unknown) const noexcept {
    const int a = rows_.slot[at(i)];
    if (a < 0) {
      for (const VertexForce& f : forces) unknown(f);
      return;
    }
    using Column = Eigen::Map<const Eigen::Vector4d>;  // and one entry of the next column
    const double* const row = block_[at(a) * columns_.most].data();
    Eigen::Vector4d x = Eigen::Vector4d::Zero(), y = x,
                    z = x;  // independent sums: a product does not wait for the last
    for (const VertexForce& f : forces) {
      const int b = columns_.slot[at(f.vertex)];
      if (b < 0) {
        unknown(f);
        continue;
      }
      const double* const c = row + 9 * b;
      const double* const force = f.force.in_model_axes().data();
      x += force[0] * Column(c);
      y += force[1] * Column(c + 3);
      z += force[2] * Column(c + 6);
    }
    sum += (x + y + z).head<3>();
  }

  /// C_ij; null when it is not known.
  const Matrix3* find(int i, int j) const noexcept {
    const int a = rows_.slot[at(i)], b = columns_.slot[at(j)];
    return a < 0 || b < 0 ? nullptr : &block_[at(a) * columns_.most + at(b)];
  }

 private:
  struct List {
    List() = default;
    List(std::size_t vertices, std::size_t largest)
        : most(std::min(vertices, largest)), slot(vertices, -1), listed(most) {}
    void resize(std::size_t vertices, std::size_t largest) {
      most = std::min(vertices, largest);
      count = 0;
      slot.assign(vertices, -1);
      listed.resize(most);
    }
    void set(std::span<const int> vertices) noexcept {
      for (std::size_t k = 0; k < count; ++k) slot[at(listed[k])] = -1;
      count = std::min(vertices.size(), most);
      for (std::size_t k = 0; k < count; ++k) {
        listed[k] = vertices[k];
        slot[at(listed[k])] = static_cast<int>(k);
      }
    }
    std::size_t most = 0, count = 0;
    std::vector<int> slot = {};    // per vertex, -1: not listed
    std::vector<int> listed = {};  // the first `count`
  };
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  /// One block more than are used: `multiply` reads beyond a column.
  std::size_t room() const noexcept { return rows_.most * columns_.most + 1; }

  List rows_, columns_;
  std::vector<Matrix3> block_;  // row i at i * columns_.most: a tick sums over the columns
};

}}}  // namespace palpate::detail
