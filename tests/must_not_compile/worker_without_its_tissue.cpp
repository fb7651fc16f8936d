// expect: this tissue needs background_work(), report_slow(bool) noexcept and report_failed(bool)
// A class that wraps a tissue without its background work: the worker would start no thread, and the tissue never move.
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/haptic/background_worker.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
struct Watched : TissueAdaptor<TissueGroup> {
  using TissueAdaptor::TissueAdaptor;
};
#else
struct Watched {
  explicit Watched(TissueGroup& tissue) : inner(tissue) {}
  TissueGroup& inner;
};
#endif

void work(TissueGroup& group) {
  Watched watched(group);
  BackgroundWorker worker(watched);
}
