// expect: this tissue needs background_work(), report_slow(bool) noexcept and report_failed(bool)
// A class that wraps a tissue without its background work: the worker would start no thread, and the tissue never move.
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/model/static/linear_tissue.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
struct Watched : TissueAdaptor<LinearTissue<double>> {
  using TissueAdaptor::TissueAdaptor;
};
#else
struct Watched {
  explicit Watched(LinearTissue<double>& tissue) : inner(tissue) {}
  LinearTissue<double>& inner;
};
#endif

void work(LinearTissue<double>& organ) {
  Watched watched(organ);
  BackgroundWorker worker(watched);
}
