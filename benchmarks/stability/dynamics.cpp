// The sweep over schemes, time steps and materials of dynamics.
#include "dynamics_schemes.hpp"

#include <palpate/assembly/free_stiffness.hpp>

#include <Eigen/Eigenvalues>

#include <cstdio>
#include <fstream>

namespace maps {
namespace {

constexpr std::array ratios{0.3, 0.45, 0.49, 0.4999};
constexpr int lowest_dt = -6, highest_dt = 0, lowest_young = 2, highest_young = 8;  // powers of ten

DynamicProblem block(int cells, int steps, double young, double nu) {
  DynamicProblem p;
  p.mesh = box_tet4({0.1, 0.1, 0.1}, {cells, cells, cells}, BoxSplit::six);
  p.young = young;
  p.nu = nu;
  p.scene.fix("z0").gravity({9.81, 0.0, 0.0});
  p.steps = steps;
  return p;
}

/// Stable time step 2 / omega_max [s] of the block at rest, by a dense eigenvalue problem.
double stable_step(const DynamicProblem& p) {
  const DeformableBody body = make_deformable_body(neo_hookean(p), p.scene);
  BlockMatrix k = detail::make_stiffness(body.pattern, {});
  body.elastic->tangent(VectorX::Zero(body.load.size()), k);
  MatrixX dense = MatrixX(free_matrix(k, body.conditions));
  for (Index i = 0; i < dense.rows(); ++i)
    for (Index j = 0; j <= i; ++j) {
      const auto mass = [&](Index f) {
        return body.lumped[body.conditions.free_dofs[static_cast<std::size_t>(f)] / 3];
      };
      dense(i, j) /= std::sqrt(mass(i) * mass(j));
    }
  const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(dense, Eigen::EigenvaluesOnly);
  return 2.0 / std::sqrt(eigen.eigenvalues().maxCoeff());
}

}  // namespace

DynamicMap measure_dynamics(int cells, int steps, const std::string& folder) {
  std::ofstream csv(folder + "/dynamics.csv");
  csv << "whose,scheme,nu,young_pa,dt_s,limit_s,verdict,energy_error,steps,remark\n";
  std::vector<Scheme> schemes = our_schemes();
  for (const Scheme& s : plain_schemes()) schemes.push_back(s);
  DynamicMap map;
  for (const Scheme& scheme : schemes)
    for (double nu : ratios) {
      std::array<char, 80> title{};
      std::snprintf(title.data(), title.size(), "%s, nu %g", scheme.name.c_str(), nu);
      Grid grid{.title = title.data(), .columns = {}, .rows = {}, .squares = {}};
      for (int d = 2 * lowest_dt; d <= 2 * highest_dt; ++d) grid.columns.push_back(power_of_ten(d));
      for (int decade = lowest_young; decade <= highest_young; ++decade) {
        grid.rows.push_back("1e" + std::to_string(decade));
        const DynamicProblem problem = block(cells, steps, std::pow(10.0, decade), nu);
        const double limit = stable_step(problem);
        grid.line.push_back({2.0 * (std::log10(limit) - lowest_dt), static_cast<double>(decade - lowest_young)});
        for (int d = 2 * lowest_dt; d <= 2 * highest_dt; ++d) {
          const double dt = std::pow(10.0, 0.5 * d);
          const Moved moved = scheme.move(problem, dt);
          std::array<char, 300> tip{};
          std::snprintf(tip.data(), tip.size(),
                        "%s, nu %g, E %.0e Pa, dt %.2g s (2/omega %.2g s): %s, energy error %.2g; %s",
                        scheme.name.c_str(), nu, problem.young, dt, limit, name(moved.verdict), moved.energy_error,
                        moved.why.c_str());
          csv << (scheme.ours ? "palpate" : "other") << ",\"" << scheme.name << "\"," << nu << ',' << problem.young
              << ',' << dt << ',' << limit << ',' << name(moved.verdict) << ',' << moved.energy_error << ','
              << moved.steps << ",\"" << moved.why << "\"\n";
          if (scheme.ours && moved.verdict == Verdict::wrong) std::printf("WRONG %s\n", tip.data());
          (scheme.ours ? map.score.ours : map.score.others)[scheme.name].add(moved.verdict);
          grid.squares.push_back({moved.verdict, shade_of_error(moved.energy_error), tip.data()});
        }
      }
      (scheme.ours ? map.ours : map.others).push_back(std::move(grid));
      std::printf("dynamics: %s done\n", title.data());
      std::fflush(stdout);
    }
  return map;
}

}  // namespace maps
