// Sums over the rows of the compliance, with the kernels of every processor, against sums over blocks.
#include <palpate/contact/detail/contact_kernels.hpp>
#include <palpate/contact/detail/row_compliance.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"
#include "kernels_of_processors.hpp"

namespace row_compliance_test {
using namespace palpate;
using any_flags::ContactKernels;

/// Those that this processor can execute.
test::NamedKernels<ContactKernels> executable_kernels() {
#if defined(PALPATE_KERNELS_BY_PROCESSOR)
  return test::executable(detail::contact_kernels(), detail::contacts_here, &any_flags::contacts_avx2,
                          &any_flags::contacts_avx512);
#else
  return test::executable<ContactKernels>(detail::contact_kernels(), detail::contacts_here, nullptr, nullptr);
#endif
}

/// Random rows of three tools, and the same in plain matrices.
struct Rows {
  explicit Rows(int count, const ContactKernels& kernels = detail::contacts_here) : compliance(count, kernels) {
    for (int i = 0; i < count; ++i) {
      compliance.begin_row(i, {static_cast<std::uint64_t>(i + 1), 1.0});
      for (int j = 0; j <= i; ++j) {
        Matrix3 a = random_matrix();
        if (i == j) a = (a + a.transpose()).eval();
        compliance.set(i, j, a);
        block(i, j) = a;
        block(j, i) = a.transpose();
      }
      tool.push_back(i % 3);
      arm.push_back(random_matrix().col(0));
      axes.push_back(random_matrix());
      compliance.set_tool(i, tool.back(), arm.back());
      compliance.set_axis(i, detail::RowCompliance::first_tangent, axes.back().col(0));
      compliance.set_axis(i, detail::RowCompliance::second_tangent, axes.back().col(1));
      compliance.set_axis(i, detail::RowCompliance::normal, axes.back().col(2));
    }
  }
  Matrix3 random_matrix() {
    Matrix3 m;
    for (int k = 0; k < 9; ++k) m.data()[k] = random.uniform(-1.0, 1.0);
    return m;
  }
  Matrix3& block(int i, int j) { return blocks[static_cast<std::size_t>(i * 100 + j)]; }
  /// The displacement at i per force at j, with the coupling: a rotation by c (arm_j x force) moves arm_i.
  Matrix3 coupled(int i, int j, const detail::RowCompliance::Coupling& c) {
    Matrix3 m = block(i, j);
    if (tool[at(i)] != tool[at(j)]) return m;
    m += c.translation * Matrix3::Identity();
    for (int k = 0; k < 3; ++k) m.col(k) += c.rotation * cross(cross(arm[at(j)], Vector3::Unit(k)), arm[at(i)]);
    return m;
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  testing::Random random{7};
  detail::RowCompliance compliance;
  std::vector<Matrix3> blocks = std::vector<Matrix3>(10000);
  std::vector<int> tool;
  std::vector<Vector3> arm;
  std::vector<Matrix3> axes;
};

TEST_CASE("Rows of the compliance along normals and in axes are those of single blocks", "[contact]") {
  const auto [name, kernels] = GENERATE(from_range(executable_kernels()));
  for (const int count : {1, 2, 4, 5, 17, 30})
    for (const detail::RowCompliance::Coupling& coupling :
         {detail::RowCompliance::Coupling{}, detail::RowCompliance::Coupling{0.7, 0.0},
          detail::RowCompliance::Coupling{0.7, 0.4}}) {
      Rows rows(count, *kernels);
      std::vector<double> w(rows.compliance.stride()), all(9 * rows.compliance.stride());
      double error = 0.0;
      for (int i = 0; i < count; ++i) {
        rows.compliance.along_normals(i, coupling, w.data());
        rows.compliance.in_axes(i, coupling, all.data());
        for (int j = 0; j <= i; ++j) {
          const Matrix3 local =
              rows.axes[Rows::at(i)].transpose() * rows.coupled(i, j, coupling) * rows.axes[Rows::at(j)];
          error = std::max(error, std::abs(w[Rows::at(j)] - local(2, 2)));
          for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
              error = std::max(
                  error, std::abs(all[Rows::at(3 * a + b) * rows.compliance.stride() + Rows::at(j)] - local(a, b)));
        }
      }
      CAPTURE(name, count, coupling.translation, coupling.rotation);
      CHECK(error < 5e-13);
    }
}

TEST_CASE("Displacements of rows are sums over blocks and loads", "[contact]") {
  const auto [name, kernels] = GENERATE(from_range(executable_kernels()));
  for (const int count : {1, 3, 4, 8, 17, 30})
    for (const int loaded : {0, 1, count / 2, count}) {
      Rows rows(count, *kernels);
      detail::RowVectors forces(count), displacements(count);
      std::vector<Vector3> force;
      for (int i = 0; i < count; ++i) {
        force.push_back(i < loaded ? Vector3(rows.random_matrix().col(1)) : Vector3(Vector3::Zero()));
        forces.set(i, force.back());
      }
      forces.pad(count);
      rows.compliance.displace(count, loaded, forces, displacements);
      double error = 0.0;
      for (int i = 0; i < count; ++i) {
        Vector3 sum = Vector3::Zero();
        for (int j = 0; j < loaded; ++j) sum += rows.block(i, j) * force[Rows::at(j)];
        error = std::max(error, (displacements[i] - sum).norm());
      }
      CAPTURE(name, count, loaded);
      CHECK(error < 5e-13);
    }
}

TEST_CASE("A row that changes makes those after it unknown", "[contact]") {
  Rows rows(6);
  CHECK(rows.compliance.knows(5, {6, 1.0}));
  CHECK(!rows.compliance.knows(5, {6, 2.0}));  // another area
  CHECK(!rows.compliance.knows(5, {7, 1.0}));  // another point
  rows.compliance.begin_row(3, {9, 1.0});
  CHECK(rows.compliance.knows(2, {3, 1.0}));
  CHECK(rows.compliance.knows(3, {9, 1.0}));
  CHECK(!rows.compliance.knows(4, {5, 1.0}));
  // A displacement reads no number of the row that was there before.
  for (int j = 0; j <= 3; ++j) rows.compliance.set(3, j, Matrix3::Identity());
  detail::RowVectors forces(6), displacements(6);
  for (int i = 0; i < 4; ++i) forces.set(i, Vector3::UnitX());
  rows.compliance.displace(4, 4, forces, displacements);
  CHECK((displacements[3] - 4.0 * Vector3::UnitX()).norm() < 1e-14);
}

}  // namespace row_compliance_test
