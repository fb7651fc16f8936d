// Assembly of the standard block compared with triplets and setFromTriplets, in nanoseconds per tetrahedron.
#include "../common/bodies.hpp"
#include "setup.hpp"

namespace setup {
namespace {

using namespace palpate;

/// The standard approach without this library: 144 triplets per element.
SparseMatrix from_triplets(const Body<Tet4>& body) {
  std::vector<Eigen::Triplet<double, Index>> entries;
  entries.reserve(144 * body.mesh.elements.size());
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const auto k = detail::element_stiffness<Tet4>(element_nodes<Tet4>(body.mesh, e), body.elasticity_of(e));
    const auto dof = [&](int i) { return 3 * Index{body.mesh.element_node(e, i / 3)} + i % 3; };
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) entries.emplace_back(dof(i), dof(j), k(i, j));
  }
  const Index size = 3 * body.mesh.node_count();
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

void measure_assembly(Session& session) {
  for (const int n : {10, 16, 24}) {
    const Body<Tet4> body = bench::standard_block(n).body();
    BlockMatrix blocks;
    SparseMatrix matrix;
    const auto [ours, theirs] =
        bench::medians_in_turns([&] { blocks = assemble_stiffness<Tet4>(body, {}); },
                                [&] { matrix = from_triplets(body); }, {.seconds = 2.0, .least = 3, .most = 15});
    const VectorX x = bench::random_matrix(matrix.rows(), 1), expected = matrix * x;
    VectorX y(x.size());
    blocks.apply(x, y);
    const double tets = static_cast<double>(body.mesh.element_count());
    session.rows.add({.target = "assembly",
                      .what = at_size("setFromTriplets / ours, per Tet4", n),
                      .figure = bench::with_unit(1e9 * ours / tets, "ns"),
                      .baseline = bench::with_unit(1e9 * theirs / tets, "ns"),
                      .ratio = theirs / ours,
                      .bound = bench::at_least(n < 16 ? 10.0 : 30.0),
                      .error = error_over((y - expected).norm() / expected.norm(), 1e-12, "product differs")});
  }
}

}  // namespace setup
