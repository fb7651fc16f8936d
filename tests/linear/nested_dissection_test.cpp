// Elimination orders, separators and trees against their definitions.
#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/elimination_tree.hpp>
#include <palpate/linear/detail/flow_separator.hpp>
#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/detail/level_order.hpp>
#include <palpate/linear/detail/nested_dissection.hpp>
#include <palpate/linear/detail/part_lists.hpp>
#include <palpate/linear/detail/separator.hpp>
#include <palpate/linear/detail/separator_refinement.hpp>

#include <Eigen/SparseCholesky>

#include "linear/sparse_cases.hpp"

#include <bit>

using namespace test;

namespace {

bool is_permutation(const detail::NodeVector& order, Index n) {
  detail::IndexedVector<char> seen(n, 0);
  for (NodeId v : order) {
    if (v < 0 || v >= n || seen[v] != 0) return false;
    seen[v] = 1;
  }
  return order.size() == n;
}

/// Row counts of every column of the factor, by elimination on a dense pattern.
std::vector<Index> dense_counts(const detail::NodeGraph& g, const detail::NodeVector& order) {
  const Index n = order.size();
  detail::NodeVector position(n);
  for (Index i = 0; i < n; ++i) position[order[i]] = static_cast<NodeId>(i);
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> a(n, n);
  a.setConstant(false);
  for (Index v = 0; v < n; ++v)
    for (Index p = g.start[v]; p < g.start[v + 1]; ++p) a(position[v], position[g.neighbour[p]]) = true;
  std::vector<Index> counts;
  for (Index j = 0; j < n; ++j) {
    Index count = g.weight(order[j]);
    for (Index i = j + 1; i < n; ++i) {
      if (!a(i, j)) continue;
      count += g.weight(order[i]);
      for (Index k = j + 1; k < n; ++k) a(i, k) = a(i, k) || a(k, j);
    }
    counts.push_back(count);
  }
  return counts;
}

}  // namespace

TEST_CASE("nested dissection orders every node once, kept ones last", "[linear][ordering]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    const detail::NodeGraph g = detail::node_graph(c.lower, c.layout);
    CHECK(is_permutation(detail::nested_dissection(g), g.nodes()));
    DofLayout layout = c.layout;
    for (Index dof = 0; dof < c.lower.rows(); dof += 7) layout.kept.push_back(dof);
    const detail::NodeGraph with_kept = detail::node_graph(c.lower, layout);
    const detail::NodeVector order = detail::nested_dissection(with_kept);
    REQUIRE(is_permutation(order, with_kept.nodes()));
    bool in_kept = false, sorted = true;
    for (NodeId v : order) {
      sorted = sorted && (with_kept.kept[v] != 0 || !in_kept);
      in_kept = in_kept || with_kept.kept[v] != 0;
    }
    CHECK(sorted);
  }
}

TEST_CASE("the dofs of a node stay together", "[linear][ordering]") {
  const SparseCase c = sphere_case(3);
  const detail::CholeskyAnalysis analysis(c.lower, c.layout);
  const detail::NodeVector& place = analysis.tree().place_of_dof;
  for (std::size_t dof = 1; dof < c.layout.node_of_dof.size(); ++dof)
    if (c.layout.node_of_dof[dof] == c.layout.node_of_dof[dof - 1])
      CHECK(place[static_cast<Index>(dof)] == place[static_cast<Index>(dof) - 1] + 1);
  // Without a layout, nodes are found from the pattern.
  const detail::NodeGraph given = detail::node_graph(c.lower, c.layout), found = detail::node_graph(c.lower, {});
  CHECK(found.nodes() <= given.nodes());
}

TEST_CASE("a separator separates", "[linear][ordering]") {
  const bool refined = GENERATE(false, true);
  for (bool coordinates : {true, false}) {
    SparseCase c = sphere_case(5);
    if (!coordinates) c.layout.positions.clear();
    const detail::NodeGraph g = detail::node_graph(c.lower, c.layout);
    detail::PartLists lists;
    lists.graph = &g;
    lists.place.assign(g.nodes(), {});
    lists.side.assign(g.nodes(), detail::side_first);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (Index v = 0; v < g.nodes(); ++v) lists.sorted[axis].push_back(static_cast<NodeId>(v));
      if (coordinates)
        std::sort(lists.sorted[axis].begin(), lists.sorted[axis].end(), [&](NodeId a, NodeId b) {
          return g.positions[static_cast<std::size_t>(a)][static_cast<int>(axis)] <
                 g.positions[static_cast<std::size_t>(b)][static_cast<int>(axis)];
        });
    }
    for (Index v = 0; v < g.nodes(); ++v) lists.place[v].label = 0;
    const detail::Part all{0, g.nodes(), 0};
    if (!coordinates) detail::LevelOrder(lists).sort(all);
    std::array<Index, 3> sizes = detail::SeparatorFinder(lists).cut(all);
    const double before = detail::separator_score(sizes, g.nodes());
    if (refined) {
      sizes = detail::SeparatorRefinement(lists).refine(all, sizes);
      CHECK(detail::separator_score(sizes, g.nodes()) <= before);
      std::array<Index, 3> counted{};
      for (detail::Side s : lists.side) ++counted[s];
      CHECK(counted == sizes);
    }
    CHECK(sizes[0] + sizes[1] + sizes[2] == g.nodes());
    CHECK(std::min(sizes[0], sizes[1]) >= g.nodes() / 5);
    CHECK(sizes[2] <= g.nodes() / 5);
    Index crossing = 0;
    for (Index v = 0; v < g.nodes(); ++v)
      for (Index p = g.start[v]; p < g.start[v + 1]; ++p)
        crossing += lists.side[v] == detail::side_first && lists.side[g.neighbour[p]] == detail::side_second;
    CHECK(crossing == 0);
  }
}

TEST_CASE("a vertex cover covers every edge and is minimal", "[linear][ordering]") {
  testing::Random random(11);
  for (int trial = 0; trial < 200; ++trial) {
    constexpr Index n = 7;
    std::vector<std::pair<Index, Index>> edges;
    detail::BipartiteCover cover;
    cover.clear();
    for (Index l = 0; l < n; ++l) {
      for (NodeId r = 0; r < n; ++r)
        if (random.uniform() < 0.25) {
          cover.add_edge(r);
          edges.emplace_back(l, r);
        }
      cover.end_left();
    }
    cover.solve(n);
    int size = 0, smallest = 2 * n;
    for (Index i = 0; i < n; ++i) size += cover.left_in_cover(i) + cover.right_in_cover(i);
    for (const auto& [l, r] : edges) CHECK((cover.left_in_cover(l) || cover.right_in_cover(r)));
    for (unsigned set = 0; set < 1u << (2 * n); ++set) {
      if (std::popcount(set) >= smallest) continue;
      bool meets = true;
      for (const auto& [l, r] : edges) meets = meets && ((set >> l & 1u) != 0 || (set >> (n + r) & 1u) != 0);
      if (meets) smallest = std::popcount(set);
    }
    CHECK(size == smallest);
  }
}

TEST_CASE("a flow finds the smallest set between two ends", "[linear][ordering]") {
  testing::Random random(13);
  int joined = 0, blocked = 0;
  for (int trial = 0; trial < 400; ++trial) {
    constexpr NodeId n = 13, first = 3, last = 10;
    const double density = random.uniform(0.1, 0.5);
    std::vector<unsigned> near(n, 0);
    detail::NodeGraph g;
    for (NodeId a = 0; a < n; ++a)
      for (NodeId b = a + 1; b < n; ++b)
        if ((a >= first || b < last) && random.uniform() < density) near[a] |= 1u << b, near[b] |= 1u << a;
    const bool join = trial % 20 == 0;
    if (join) near[0] |= 1u << (n - 1), near[n - 1] |= 1u;
    g.start.push_back(0);
    for (NodeId a = 0; a < n; ++a) {
      for (NodeId b = 0; b < n; ++b)
        if ((near[a] >> b & 1u) != 0) g.neighbour.push_back(b);
      g.start.push_back(g.neighbour.size());
    }
    detail::PartLists lists;
    lists.graph = &g;
    lists.place.assign(n, {});
    lists.side.assign(n, detail::side_first);
    for (NodeId v = 0; v < n; ++v) lists.sorted[0].push_back(v), lists.place[v] = {{v, v, v}, 0};
    const detail::Part all{0, n, 0};
    detail::FlowSeparator flow(lists);
    const std::array<Index, 3> sizes = flow.cut(all, 0, first, last);
    if (join) {
      ++joined;
      CHECK(sizes == std::array<Index, 3>{n, 0, 0});
      continue;
    }
    flow.mark(all, 0, first);
    // Every set of inner nodes: reach as far as possible from the first nodes.
    int smallest = last - first;
    for (unsigned set = 0; set < 1u << (last - first); ++set) {
      const unsigned removed = set << first;
      unsigned reached = (1u << first) - 1, before = 0;
      while (reached != before) {
        before = reached;
        for (NodeId v = 0; v < n; ++v)
          if ((before >> v & 1u) != 0) reached |= near[v] & ~removed;
      }
      if ((reached >> last) == 0) smallest = std::min(smallest, std::popcount(set));
    }
    blocked += smallest > 0;
    std::array<Index, 3> counted{};
    for (detail::Side s : lists.side) ++counted[s];
    CHECK(counted == sizes);
    CHECK(sizes[2] == smallest);
    bool separated = true;
    for (NodeId v = 0; v < n; ++v) {
      if (v < first) separated = separated && lists.side[v] == detail::side_first;
      if (v >= last) separated = separated && lists.side[v] == detail::side_second;
      for (NodeId u = 0; u < n; ++u)
        separated = separated && !((near[v] >> u & 1u) != 0 && lists.side[v] == detail::side_first &&
                                   lists.side[u] == detail::side_second);
    }
    CHECK(separated);
  }
  CHECK(joined == 20);
  CHECK(blocked > 100);
}

TEST_CASE("the elimination order does not depend on the threads", "[linear][ordering][threads]") {
  for (bool coordinates : {true, false}) {
    SparseCase c = sphere_case(13);
    if (!coordinates) c.layout.positions.clear();
    const detail::NodeGraph g = detail::node_graph(c.lower, c.layout);
    const detail::NodeVector one = detail::nested_dissection(g);
    REQUIRE(is_permutation(one, g.nodes()));
    for (int threads : {2, 3, 7}) {
      SetupLimits limits;
      limits.threads = threads;
      const detail::NodeVector several = detail::nested_dissection(g, limits);
      CHECK(std::equal(one.begin(), one.end(), several.begin(), several.end()));
    }
  }
}

TEST_CASE("a dissection by threads can be cancelled", "[linear][ordering][threads]") {
  const SparseCase c = sphere_case(13);
  const detail::NodeGraph g = detail::node_graph(c.lower, c.layout);
  for (int threads : {1, 3})
    for (int last : {1, 2}) {
      int calls = 0;
      SetupLimits limits;
      limits.threads = threads;
      limits.progress = [&](const Progress&) { return ++calls < last; };
      if (threads == 1 || last == 1) CHECK_REFUSED(SetupErrorKind::cancelled, detail::nested_dissection(g, limits));
      CHECK(calls <= last);
    }
}

TEST_CASE("row counts equal those of dense elimination", "[linear][ordering]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    const detail::NodeGraph g = detail::node_graph(c.lower, c.layout);
    if (g.nodes() > 200) continue;
    const detail::EliminationTree t = detail::elimination_tree(g, detail::nested_dissection(g));
    const std::vector<Index> expected = dense_counts(g, t.order);
    for (Index j = 0; j < g.nodes(); ++j) CHECK(t.rows[j] == expected[static_cast<std::size_t>(j)]);
    for (Index j = 0; j < g.nodes(); ++j) CHECK((t.parent[j] < 0 || t.parent[j] > j));
  }
}

TEST_CASE("fronts cover the matrix and have the right rows", "[linear][ordering]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    DofLayout layout = c.layout;
    for (bool keep : {false, true}) {
      if (keep)
        for (Index dof = 1; dof < c.lower.rows(); dof += 5) layout.kept.push_back(dof);
      const detail::CholeskyAnalysis analysis(c.lower, layout);
      Index pivots = 0;
      for (const detail::Front& f : analysis.tree().fronts) {
        CHECK(f.first == pivots);
        pivots += f.pivots;
        Index rows = 0;
        for (Index r = f.run_begin; r < f.run_end; ++r) {
          CHECK(analysis.tree().runs[r].first >= pivots);
          rows += analysis.tree().runs[r].count;
        }
        CHECK(rows == f.rows);
      }
      CHECK(pivots == c.lower.rows());
      if (keep && !layout.kept.empty())
        CHECK(analysis.tree().fronts.back().pivots == static_cast<Index>(layout.kept.size()));
    }
  }
}

TEST_CASE("the elimination order keeps fill low", "[linear][ordering]") {
  const SparseCase c = sphere_case(6);
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<Index>> minimum_degree;
  minimum_degree.analyzePattern(c.lower);
  minimum_degree.factorize(c.lower);
  const auto reference = static_cast<double>(SparseMatrix(minimum_degree.matrixL()).nonZeros());
  CHECK(detail::CholeskyAnalysis(c.lower, c.layout).nonzeros() <= 1.15 * reference);
  CHECK(detail::CholeskyAnalysis(c.lower, {}).nonzeros() <= 1.4 * reference);
}

TEST_CASE("layouts that do not fit are refused", "[linear][ordering]") {
  const SparseMatrix lower = sphere_stiffness(1);
  const auto n = static_cast<std::size_t>(lower.rows());
  DofLayout layout;
  SECTION("too few nodes") {
    layout.node_of_dof.assign(n - 1, 0);
  }
  SECTION("a negative node") {
    layout.node_of_dof.assign(n, -1);
  }
  SECTION("a node without coordinates") {
    layout.node_of_dof.assign(n, 3);
    layout.positions.assign(3, Vector3::Zero());
  }
  SECTION("coordinates without nodes") {
    layout.positions.assign(3, Vector3::Zero());
  }
  SECTION("a coordinate that is not finite") {
    layout.node_of_dof.assign(n, 0);
    layout.positions.assign(1, Vector3(0.0, infinity, 0.0));
  }
  SECTION("kept twice") {
    layout.kept = {2, 5, 2};
  }
  SECTION("kept beyond the end") {
    layout.kept = {lower.rows()};
  }
  CHECK_REFUSED(SetupErrorKind::bad_argument, detail::CholeskyAnalysis(lower, layout));
}
