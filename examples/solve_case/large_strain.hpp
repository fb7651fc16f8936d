// Static load cases at large deformation with elements E.
#pragma once

#include <palpate/material/mooney_rivlin.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/model/moving/equilibrium.hpp>

#include <chrono>

#include "solve.hpp"

namespace solve_case {

/// Reads a material of the case file as M.
template <class M>
struct MaterialReader;

template <class M>
M read_by_modulus(const json& m) {
  return {.youngs_modulus = m.at("E").get<double>(),
          .poisson_ratio = m.at("nu").get<double>(),
          .density = m.value("rho", 0.0)};
}
template <>
struct MaterialReader<palpate::NeoHookeanIsochoric> {
  static constexpr const char* name = "neo_hooke_iso";
  static palpate::NeoHookeanIsochoric read(const json& m) { return read_by_modulus<palpate::NeoHookeanIsochoric>(m); }
};
template <>
struct MaterialReader<palpate::NeoHookeanLogarithmic> {
  static constexpr const char* name = "neo_hooke_log";
  static palpate::NeoHookeanLogarithmic read(const json& m) {
    return read_by_modulus<palpate::NeoHookeanLogarithmic>(m);
  }
};
template <>
struct MaterialReader<palpate::StVenantKirchhoff> {
  static constexpr const char* name = "svk";
  static palpate::StVenantKirchhoff read(const json& m) { return read_by_modulus<palpate::StVenantKirchhoff>(m); }
};
template <>
struct MaterialReader<palpate::MooneyRivlin> {
  static constexpr const char* name = "mooney_rivlin_iso";
  static palpate::MooneyRivlin read(const json& m) {
    return {.c10 = m.at("C10").get<double>(),
            .c01 = m.at("C01").get<double>(),
            .bulk_modulus = 2.0 / m.at("D1").get<double>(),
            .density = m.value("rho", 0.0)};
  }
};

/// The material of each region, all of one type.
template <class M>
palpate::RegionMaterials<M> read_hyperelastic(const json& load_case) {
  palpate::RegionMaterials<M> materials;
  for (const auto& [region, m] : load_case.at("materials").items()) {
    if (m.at("model") != MaterialReader<M>::name)
      palpate::raise(SetupErrorKind::unsupported, "regions with materials of different types");
    allow_keys(m, "material '" + region + "'", {"model", "E", "nu", "mu", "K", "lambda", "C10", "C01", "D1", "rho"});
    materials.emplace_back(region, MaterialReader<M>::read(m));
  }
  return materials;
}

template <class M, palpate::Element E>
Solution solve_with(const palpate::Mesh<E>& mesh, const json& load_case) {
  const palpate::Scene scene = read_scene(load_case, mesh);
  const auto materials = read_hyperelastic<M>(load_case);

  const auto start = std::chrono::steady_clock::now();
  palpate::Admitted<E> admitted = palpate::admit<E>(mesh);
  palpate::Equilibrium body(palpate::make_hyperelastic_body(std::move(admitted.mesh), materials),
                            scene.mapped(admitted.node_map, palpate::Vector3::Zero()));
  const palpate::EquilibriumReport report = body.solve();
  if (!report.converged || !report.stable || report.deformation.inverted > 0)
    palpate::raise(SetupErrorKind::not_converged, palpate::describe(report), "Try smaller loads");
  Solution s{body.displacement(),
             body.internal_force(),
             body.reactions(),
             body.energy(),
             {},
             constrained_nodes(mesh, scene),
             0.0};
  s.node_map = std::move(admitted.node_map);
  s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return s;
}

/// Equilibrium under the loads of a load case, with the material model it names. Throws SetupError.
template <palpate::Element E>
Solution solve_large_strain(const palpate::Mesh<E>& mesh, const json& load_case) {
  check_analysis(load_case, large_strain_statics);
  const auto& materials = load_case.at("materials");
  const auto model =
      materials.empty() ? std::string("none") : materials.begin()->at("model").template get<std::string>();
  Solution solution;
  const auto tried = [&]<class M>(std::type_identity<M>) {
    if (model != MaterialReader<M>::name) return false;
    solution = solve_with<M>(mesh, load_case);
    return true;
  };
  if (tried(std::type_identity<palpate::NeoHookeanIsochoric>{}) ||
      tried(std::type_identity<palpate::NeoHookeanLogarithmic>{}) ||
      tried(std::type_identity<palpate::MooneyRivlin>{}) || tried(std::type_identity<palpate::StVenantKirchhoff>{}))
    return solution;
  palpate::raise(SetupErrorKind::unsupported, "the material model '" + model + "' at large deformation");
}

}  // namespace solve_case
