#include "surface_maker.hpp"

namespace live {

SurfaceMaker::SurfaceMaker(Organ& organ, const ServoSnapshot& snapshot, Field field) : organ_(&organ) {
  if (organ_->draw(snapshot, field, made_.back())) made_.publish();
  thread_ = std::thread([this] { run(); });
}

SurfaceMaker::~SurfaceMaker() {
  ends_ = true;
  ++asked_;
  asked_.notify_one();
  thread_.join();
}

void SurfaceMaker::ask(const ServoSnapshot& snapshot, Field field) {
  wishes_.back().snapshot = snapshot;
  wishes_.back().field = field;
  wishes_.publish();
  ++asked_;
  asked_.notify_one();
}

const DrawnSurface& SurfaceMaker::newest() noexcept {
  made_.update();
  return made_.front();
}

void SurfaceMaker::run() {
  for (;;) {
    const unsigned seen = asked_;
    if (ends_) return;
    if (!wishes_.update()) {
      asked_.wait(seen);
      continue;
    }
    const std::scoped_lock lock(drawing_);
    if (organ_->draw(wishes_.front().snapshot, wishes_.front().field, made_.back())) made_.publish();
  }
}

}  // namespace live
