// The local compliance of every tool on coarse facets.
#pragma once

#include <palpate/contact/detail/contact_rows.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// ContactTool::local_compliance within a tick: the secant of LocalIndentation at the tool's force. It depends on the
/// force, and the force on it: after each linearisation the force is estimated at which both agree, for a contact that
/// keeps its shape; for a single contact that is exact. Tools that touch no coarse facets cost a comparison. While a
/// tool grasps, its compliance stays. No allocation.
class LocalContact {
 public:
  using Tools = std::span<ContactTool>;

  /// Sets the compliance of tools that do not press yet: that of the smallest forces, on the facet nearest to them.
  void start(Tools tools, Candidates& candidates) const noexcept;
  /// After a linearisation: computes the compliance for the next. Returns the expected relative change of the force.
  double predict(Tools tools, const Candidates& candidates, const ContactRows& rows) noexcept;
  /// Before a linearisation: sets what `predict` computed.
  void apply(Tools tools) noexcept;
  /// coarse_contact if tool `t` presses coarse facets and most of its indentation is local, beyond the range of Hertz's
  /// theory, or left out in part or completely.
  Status status(std::size_t t, const ContactTool& tool) const noexcept;
  /// Whether the facets under a sphere or capsule pressed to `depth` [m], although they show its dent, are so long that
  /// its force may be wrong by more than a tenth: longer than three quarters of the radius of the contact, and than
  /// those that do for a depth of an eighth of the tool's radius. An estimate for where no error was measured.
  static bool presses_long_facets(std::size_t t, const ContactTool& tool, double depth, const Candidates& candidates,
                                  const ContactRows& rows) noexcept;
  void reset() noexcept { next_ = {}; }

 private:
  /// What the rows of a tool give together.
  struct Load {
    FacetScale facets;   // mean with the forces as weights; modulus: of those that are known
    double known = 0.0;  // share of the force on facets with known modulus
    double force = 0.0;  // sum of the normal forces [N]
  };
  struct Next {
    double compliance = 0.0;  // local [m/N]
    double rest = 0.0;        // that of the tissue of the mesh [m/N]
    Load load;
    bool known = false;
  };
  static Load load_of(int tool, const ContactTool& own, const Candidates& candidates, const ContactRows& rows) noexcept;

  std::array<Next, maximum_tools> next_{};
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/local_contact.ipp>
#endif
