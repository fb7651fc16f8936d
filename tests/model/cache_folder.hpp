#pragma once

#include <palpate/model/cache/detail/prepared_cache.hpp>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "model/any_model.hpp"
#include "model/reference.hpp"

namespace test {

namespace fs = std::filesystem;
using Bytes = std::vector<char>;

inline Bytes bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_bytes(const fs::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A temporary folder of one test for a cache file; removed by the destructor.
class CacheFolder {
 public:
  CacheFolder() { fs::create_directories(path_); }
  ~CacheFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  CacheFolder(const CacheFolder&) = delete;
  CacheFolder& operator=(const CacheFolder&) = delete;

  const fs::path& path() const { return path_; }
  fs::path cache() const { return path_ / "organ.palpate"; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
  }
  SetupOptions options() const {
    SetupOptions o;
    o.cache_file = cache().string();
    return o;
  }

 private:
  static int next() {
    static int count = 0;
    return count++;
  }
  /// A folder in memory when available: a disk may take milliseconds to replace a file.
  static fs::path base() { return fs::is_directory("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path(); }
  fs::path path_ =
      base() / ("palpate_cache_" + std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()) + "_" +
                std::to_string(next()));
};

/// The smallest body that has all parts of a cache: four touched nodes, eight condensed ones.
inline Mesh<Tet4> two_cells() {
  return box_tet4({0.02, 0.01, 0.01}, {2, 1, 1});
}
inline Scene two_cells_scene() {
  return Scene().fix("x0").touch("x1").gravity({0.0, 0.0, -9.81});
}

/// All results of a model: displacement, reactions, compliance, displacement under a contact force, condition.
inline std::vector<double> answers(AnyModel& model) {
  std::vector<double> all;
  const auto add = [&](const auto& m) { all.insert(all.end(), m.data(), m.data() + m.size()); };
  add(model.displacement());
  add(model.reactions());
  const auto vertices = all_vertices(model.contact_surface().vertex_count());
  for (int j : vertices) {
    CHECK(model.require_columns({&j, 1}).ok());
    for (int i : vertices) add(model.compliance(i, j));
    all.push_back(model.compliance_bound(j));
  }
  all.push_back(model.compliance_floor());
  const std::array forces{VertexForce{0, {0.1, -0.2, 0.3}}};
  VectorX u = VectorX::Zero(model.displacement().size());
  if (!vertices.empty()) model.displacement_with(forces, u);
  add(u);
  all.push_back(model.report().condition_estimate);
  all.push_back(model.report().probe_error);
  return all;
}

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace test
