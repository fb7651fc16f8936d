// The functions of palpate_tissue.
#pragma once

#include <palpate/c/detail/handles.hpp>
#include <palpate/c/detail/policies.hpp>
#include <palpate/c/detail/report_json.hpp>
#include <palpate/model/static/measured_force_error.hpp>

#include <array>
#include <cstring>
#include <limits>
#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface { namespace {

RegionMaterials<LinearElastic> materials_from(const palpate_setup& setup) {
  RegionMaterials<LinearElastic> materials;
  if (setup.material_count == 0) refuse("there is no material", "Set materials and material_count");
  if (setup.materials == nullptr) refuse("materials is null");
  const auto* next = reinterpret_cast<const unsigned char*>(setup.materials);  // an older program has shorter entries
  for (std::uint64_t i = 0; i < setup.material_count; ++i) {
    const auto& given = *reinterpret_cast<const palpate_material*>(next);
    const palpate_material m = read_struct(&given, "a material");
    materials.emplace_back(m.region == nullptr ? everywhere : std::string(m.region),
                           LinearElastic{m.youngs_modulus, m.poisson_ratio, m.density});
    next += m.struct_size;
  }
  return materials;
}

/// Calls the callback of a C program with stages that end with zero.
ProgressCallback progress_from(const palpate_setup& setup) {
  if (setup.progress == nullptr) return {};
  return [call = setup.progress, user = setup.progress_user](const Progress& progress) {
    std::array<char, 32> stage{};
    std::memcpy(stage.data(), progress.stage.data(), std::min(progress.stage.size(), stage.size() - 1));
    return call(user, stage.data(), progress.fraction) == 0;
  };
}

AdmissionPolicy admission_from(const palpate_setup& setup) {
  AdmissionPolicy policy;
  if (setup.repair == 0) return policy;
  policy.inverted = policy.degenerate = policy.duplicate_nodes = policy.duplicate_elements = Admission::repair;
  return policy;
}

ColumnFill columns_from(const palpate_setup& setup) {
  switch (setup.columns) {
    case PALPATE_COLUMNS_AUTOMATIC:
      return ColumnFill::automatic;
    case PALPATE_COLUMNS_SYNCHRONOUS:
      return ColumnFill::synchronous;
    case PALPATE_COLUMNS_ASYNCHRONOUS:
      return ColumnFill::asynchronous;
    default:
      refuse("columns has the unknown value " + std::to_string(setup.columns));
  }
}

SetupOptions options_from(const palpate_setup& setup) {
  SetupOptions options;
  options.progress = progress_from(setup);
  if (setup.memory_limit > 0 && setup.memory_limit < std::numeric_limits<std::size_t>::max())
    options.memory_limit = static_cast<std::size_t>(setup.memory_limit);
  options.admission = admission_from(setup);
  if (setup.threads < 0) refuse("a negative number of threads");
  options.threads = SetupThreads(setup.threads);
  options.columns = columns_from(setup);
  if (setup.compliance_slots != 0) options.compliance_slots = setup.compliance_slots;
  if (setup.force_error_places != 0) options.force_error = measured_force_error(setup.force_error_places);
  if (setup.cache_file != nullptr) options.cache_file = setup.cache_file;
  return options;
}

AnyTissue& tissue_of(palpate_tissue* tissue) {
  return *object(tissue, "tissue").shared->tissue;
}

/// A rigid motion. Throws non_finite or bad_argument.
Eigen::Isometry3d pose_from(const double* position, const double* quaternion) {
  const Vector3 x(numbers(position, 3, "position").data());
  const Eigen::Quaterniond q(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
  if (!(std::abs(q.norm() - 1.0) <= 1e-6) || !x.allFinite())
    raise(SetupErrorKind::bad_argument, "the pose is not a position and a unit quaternion w x y z");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = x;
  return pose;
}

}  // namespace

}}}  // namespace palpate::PALPATE_ABI::c_interface

extern "C" {

palpate_error palpate_tissue_create(const palpate_mesh* mesh, const palpate_scene* scene, const palpate_setup* setup,
                                    palpate_tissue** tissue) {
  using namespace palpate::c_interface;
  return guarded([&] {
    palpate_tissue*& out = target(tissue, "tissue");
    out = nullptr;
    const palpate_setup given = read_struct(setup, "setup");
    const Policy& policy = find_policy(given.policy);
    const TissueInput input{object(mesh, "mesh").given,
                            object(scene, "scene").scene,
                            materials_from(given),
                            options_from(given),
                            {given.step, given.mass_damping, given.quasi_static != 0}};
    auto made = std::make_unique<palpate_tissue>();
    made->shared = std::make_shared<SharedTissue>();
    made->shared->policy = policy.name;
    made->shared->tissue = policy.make(input);
    out = made.release();
  });
}

palpate_error palpate_tissue_report(const palpate_tissue* tissue, char* text, size_t capacity, size_t* length) {
  using namespace palpate::c_interface;
  return guarded([&] {
    const SharedTissue& shared = *object(tissue, "tissue").shared;
    const std::string json = to_json(shared.policy, shared.tissue->report(), shared.tissue->cut_report());
    if (length != nullptr) *length = json.size();
    if (text == nullptr && capacity == 0) return;
    if (text == nullptr || capacity <= json.size())
      refuse("the buffer of the report has " + std::to_string(capacity) + " bytes, and it needs " +
             std::to_string(json.size() + 1));
    std::memcpy(text, json.c_str(), json.size() + 1);
  });
}

palpate_error palpate_tissue_displacement(palpate_tissue* tissue, double* displacement, size_t capacity) {
  using namespace palpate::c_interface;
  return guarded([&] {
    AnyTissue& t = tissue_of(tissue);
    const std::vector<palpate::NodeId>& node_map = t.base().node_map();
    const std::size_t size = 3 * node_map.size();
    if (capacity < size)
      refuse("room for " + std::to_string(capacity) + " numbers; the nodes need " + std::to_string(size));
    double* out = numbers(displacement, size, "displacement").data();
    palpate::VectorX u;
    if (!t.displacement(u).converged)
      palpate::raise(palpate::SetupErrorKind::not_converged, "the solve for the displacement stopped early");
    for (const palpate::NodeId node : node_map)
      for (int c = 0; c < 3; ++c) *out++ = node < 0 ? std::numeric_limits<double>::quiet_NaN() : u[3 * node + c];
  });
}

palpate_error palpate_tissue_set_pose(palpate_tissue* tissue, const double* position, const double* quaternion) {
  using namespace palpate::c_interface;
  return guarded([&] {
    AnyTissue& t = tissue_of(tissue);
    if (quaternion == nullptr) refuse("quaternion is null");
    t.set_pose(pose_from(position, quaternion));
  });
}

palpate_error palpate_tissue_set_gravity(palpate_tissue* tissue, const double* gravity) {
  using namespace palpate::c_interface;
  return guarded([&] { tissue_of(tissue).set_gravity(palpate::Vector3(numbers(gravity, 3, "gravity").data())); });
}

palpate_error palpate_tissue_reset(palpate_tissue* tissue) {
  using namespace palpate::c_interface;
  return guarded([&] { tissue_of(tissue).reset(); });
}

palpate_error palpate_tissue_cut(palpate_tissue* tissue, const double* sheet) {
  using namespace palpate::c_interface;
  return guarded([&] {
    AnyTissue& t = tissue_of(tissue);
    const double* x = numbers(sheet, 12, "sheet").data();
    palpate::BladeSweep sweep;
    for (palpate::Vector3* corner : {&sweep.a0, &sweep.b0, &sweep.a1, &sweep.b1}) {
      *corner = palpate::Vector3(x);
      if (!corner->allFinite())
        palpate::raise(palpate::SetupErrorKind::non_finite, "a corner of the cut is not finite");
      x += 3;
    }
    t.cut(sweep);
  });
}

void palpate_tissue_destroy(palpate_tissue* tissue) {
  if (tissue == nullptr || tissue->tag.value != palpate_tissue::kind) return;
  tissue->tag.value = 0;
  delete tissue;
}

}  // extern "C"
