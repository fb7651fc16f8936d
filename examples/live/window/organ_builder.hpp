// Organs are made in a thread of their own, so that the picture and the present organ go on meanwhile.
#pragma once

#include "../core/organ.hpp"

#include <chrono>
#include <future>

namespace live {

class OrganBuilder {
 public:
  void begin(const TouchScene& scene, Composition composition, const Tuning& tuning) {
    made_ =
        std::async(std::launch::async, [scene, composition, tuning] { return make_organ(scene, composition, tuning); });
  }
  bool busy() const noexcept { return made_.valid(); }
  bool ready() const { return busy() && made_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
  /// Waits. Throws what the set-up threw.
  std::unique_ptr<Organ> take() { return made_.get(); }

 private:
  std::future<std::unique_ptr<Organ>> made_;
};

}  // namespace live
