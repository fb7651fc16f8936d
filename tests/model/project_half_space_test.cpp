// What meshes make of the compliance of a half-space.
#include <palpate/element/smoothed.hpp>

#include "model/half_space_bodies.hpp"

#include "catch.hpp"

using namespace test;

TEST_CASE("probe", "[half_space]") {
  TouchedBlock<Tet4> block(jittered_block<Tet4>(10, 6, 0.2), LinearElastic{1.0, 0.3, 1.0},
                           [](const Vector3& x) { return x[2] < 1e-9; }, [](const Vector3& x) { return x[2] > 5.99; });
  const ProjectedHalfSpace table = block.table();
  for (int v = 0; v < table.vertex_count(); ++v) {
    const Matrix3 g = table(v, v);
    std::printf("%d marks %d cols %zu diag %g %g %g\n", v, table.marks(v).bits, table.columns(v).size(), g(0, 0), g(1, 1), g(2, 2));
  }
}
