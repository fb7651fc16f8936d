// Linear tetrahedra without condensation.
#include <palpate/core/platform.hpp>

#include "linear.hpp"

namespace tradeoff {
namespace {

/// Ticks at 1 kHz in real time, so that columns computed in a background thread have a realistic amount of time.
class Paced : public LinearContender<Tet4, SparseCholesky> {
 public:
  using LinearContender::LinearContender;
  std::span<const Vector3> tick(std::span<const Vector3> centres) override {
    if (next_ == 0) next_ = platform::wall_ns();
    platform::sleep_until_ns(next_);  // not counted: processor time is measured
    next_ = std::max(next_ + 1'000'000, platform::wall_ns());
    return LinearContender::tick(centres);
  }

 private:
  std::int64_t next_ = 0;
};

}  // namespace

void add_tet4_uncondensed(const Bench& bench, std::vector<Entry>& entries) {
  const std::string surface(surface_group);
  for (const char* mesh : {"given", "near", "all"})
    entries.push_back(linear_entry<Tet4, SparseCholesky>(bench, "Tet4", "SparseCholesky", mesh, surface));
  const SetupOptions ahead{.columns = ColumnFill::asynchronous};
  Entry entry = linear_entry<Tet4, SparseCholesky>(bench, "Tet4", "SparseCholesky", "given", surface, ahead);
  entry.make = [&bench, surface, ahead] { return std::make_unique<Paced>(bench, "given", surface, ahead); };
  entries.push_back(entry);
  entries.push_back(linear_entry<Tet4, ConjugateGradient>(bench, "Tet4", "ConjugateGradient", "given", surface));
}

}  // namespace tradeoff
