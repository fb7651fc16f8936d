// Input that the C interface refuses: the kind of error, its text and its ids; nothing crashes and nothing is made.
#include <catch.hpp>

#include <palpate/c/palpate.h>
#include <palpate/testing/allocation_counter.hpp>

#include "box.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

palpate_error_info last() {
  palpate_error_info info;
  PALPATE_INIT(&info);
  REQUIRE(palpate_last_error(&info) == PALPATE_OK);
  return info;
}

template <auto destroy>
struct Destroy {
  template <class T>
  void operator()(T* handle) const {
    destroy(handle);
  }
};
using MeshHandle = std::unique_ptr<palpate_mesh, Destroy<palpate_mesh_destroy>>;
using SceneHandle = std::unique_ptr<palpate_scene, Destroy<palpate_scene_destroy>>;
using TissueHandle = std::unique_ptr<palpate_tissue, Destroy<palpate_tissue_destroy>>;
using SessionHandle = std::unique_ptr<palpate_session, Destroy<palpate_session_destroy>>;

/// A set-up of the box, to be changed before `create`.
struct Given {
  std::unique_ptr<box> shape = std::make_unique<box>();
  palpate_material material;
  palpate_setup setup;
  std::string fixed = "bottom";

  Given() {
    make_box(shape.get());
    PALPATE_INIT(&material);
    material.youngs_modulus = 5e3;
    material.poisson_ratio = 0.45;
    PALPATE_INIT(&setup);
    setup.policy = "tet4/linear/condensed";
    setup.material_count = 1;
  }

  MeshHandle mesh() const {
    palpate_mesh* made = nullptr;
    REQUIRE(palpate_mesh_from_arrays(shape->positions, BOX_NODES, shape->cells, BOX_CELLS, 4, nullptr, &made) ==
            PALPATE_OK);
    REQUIRE(palpate_mesh_add_group(made, "bottom", shape->bottom, shape->side) == PALPATE_OK);
    REQUIRE(palpate_mesh_add_group(made, "top", shape->top, shape->side) == PALPATE_OK);
    return MeshHandle(made);
  }
  SceneHandle scene() const {
    palpate_scene* made = nullptr;
    REQUIRE(palpate_scene_create(&made) == PALPATE_OK);
    REQUIRE(palpate_scene_fix(made, fixed.c_str()) == PALPATE_OK);
    REQUIRE(palpate_scene_touch(made, "top", 0.0) == PALPATE_OK);
    return SceneHandle(made);
  }
  palpate_error create(palpate_tissue** made) const {
    const MeshHandle m = mesh();
    const SceneHandle s = scene();
    palpate_setup complete = setup;
    complete.materials = &material;
    return palpate_tissue_create(m.get(), s.get(), &complete, made);
  }
  /// The error of a set-up, which must make nothing.
  palpate_error_info refused() const {
    auto* made = reinterpret_cast<palpate_tissue*>(1);
    const palpate_error error = create(&made);
    CHECK(made == nullptr);
    const palpate_error_info info = last();
    CHECK(error == info.kind);
    return info;
  }
  TissueHandle tissue() const {
    palpate_tissue* made = nullptr;
    REQUIRE(create(&made) == PALPATE_OK);
    return TissueHandle(made);
  }
};

palpate_tool sphere() {
  palpate_tool tool;
  PALPATE_INIT(&tool);
  return tool;
}

SessionHandle session_of(palpate_tissue* tissue) {
  const palpate_tool tool = sphere();
  palpate_session* made = nullptr;
  REQUIRE(palpate_session_create(tissue, &tool, 1, nullptr, &made) == PALPATE_OK);
  return SessionHandle(made);
}

bool has(const char* text, const char* part) {
  return std::strstr(text, part) != nullptr;
}

}  // namespace

TEST_CASE("the C interface refuses an unknown policy with a list of known ones", "[c]") {
  Given given;
  given.setup.policy = "tet4/linear/condenssed";
  palpate_error_info info = given.refused();
  CHECK(info.kind == PALPATE_INVALID_ARGUMENT);
  CHECK(has(info.text, "tet4/linear/condenssed"));
  CHECK(has(info.hint, "tet4/linear/condensed,"));
  given.setup.policy = "nonsense";
  info = given.refused();
  CHECK(info.kind == PALPATE_INVALID_ARGUMENT);
  CHECK(has(info.hint, "smoothed_tet4/linear/condensed,"));
  given.setup.policy = nullptr;
  CHECK(given.refused().kind == PALPATE_INVALID_ARGUMENT);
  given.setup.policy = "hex8/linear/condensed";  // for cells of four nodes
  CHECK(given.refused().kind == PALPATE_UNSUPPORTED);
}

TEST_CASE("the C interface passes on what a set-up refuses, with ids of the mesh as given", "[c]") {
  Given given;
  std::swap(given.shape->cells[4 * 17], given.shape->cells[4 * 17 + 1]);
  const palpate_error_info inverted = given.refused();
  CHECK(inverted.kind == PALPATE_INVERTED_ELEMENT);
  CHECK(inverted.ids_of == PALPATE_IDS_ELEMENTS);
  REQUIRE(inverted.id_count == 1);
  CHECK(inverted.count == 1);
  CHECK(inverted.ids[0] == 17);
  CHECK(inverted.text[0] != '\0');
  CHECK(inverted.hint[0] != '\0');
  given.setup.repair = 1;
  CHECK(given.tissue() != nullptr);

  Given other;
  other.material.poisson_ratio = 0.5;
  const palpate_error_info poisson = other.refused();
  CHECK(poisson.kind == PALPATE_BAD_POISSON_RATIO);
  CHECK(poisson.value == 0.5);
  other.material.poisson_ratio = not_a_number;
  CHECK(other.refused().kind != PALPATE_OK);
  other = Given();
  other.fixed = "ligament";
  CHECK(other.refused().kind == PALPATE_UNKNOWN_GROUP);
  other = Given();
  other.shape->positions[100] = not_a_number;
  CHECK(other.refused().kind == PALPATE_NON_FINITE);
  other = Given();
  other.setup.memory_limit = 1000;
  CHECK(other.refused().kind == PALPATE_TOO_LARGE);
  other = Given();
  other.setup.material_count = 0;
  CHECK(other.refused().kind == PALPATE_INVALID_ARGUMENT);
  other = Given();
  other.setup.progress = [](void*, const char*, double) -> int32_t { return 1; };
  CHECK(other.refused().kind == PALPATE_CANCELLED);
}

TEST_CASE("the C interface refuses groups and cells that do not exist", "[c]") {
  const Given given;
  const MeshHandle mesh = given.mesh();
  const std::vector<std::int32_t> nodes{0, BOX_NODES, -1, 5};
  CHECK(palpate_mesh_add_group(mesh.get(), "outside", nodes.data(), nodes.size()) == PALPATE_INDEX_OUT_OF_RANGE);
  const palpate_error_info info = last();
  CHECK(info.ids_of == PALPATE_IDS_NODES);
  REQUIRE(info.id_count == 2);
  CHECK(info.ids[0] == BOX_NODES);
  CHECK(info.ids[1] == -1);
  CHECK(palpate_mesh_add_group(mesh.get(), "", nodes.data(), 1) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_mesh_add_group(mesh.get(), nullptr, nodes.data(), 1) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_mesh_add_group(mesh.get(), "none", nullptr, 1) == PALPATE_INVALID_ARGUMENT);

  Given broken;
  broken.shape->cells[8] = 12345;
  CHECK(broken.refused().kind == PALPATE_INDEX_OUT_OF_RANGE);
  palpate_mesh* made = nullptr;
  const std::vector<std::int32_t> regions(BOX_CELLS, -3);
  CHECK(palpate_mesh_from_arrays(given.shape->positions, BOX_NODES, given.shape->cells, BOX_CELLS, 4, regions.data(),
                                 &made) == PALPATE_INDEX_OUT_OF_RANGE);
  CHECK(palpate_mesh_from_arrays(given.shape->positions, BOX_NODES, given.shape->cells, BOX_CELLS, 5, nullptr, &made) ==
        PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_mesh_from_arrays(nullptr, BOX_NODES, given.shape->cells, BOX_CELLS, 4, nullptr, &made) ==
        PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_mesh_from_arrays(given.shape->positions, std::numeric_limits<std::size_t>::max(), given.shape->cells,
                                 BOX_CELLS, 4, nullptr, &made) == PALPATE_COUNT_TOO_LARGE);
  CHECK(made == nullptr);
}

TEST_CASE("the C interface refuses null and handles of another kind", "[c]") {
  CHECK(palpate_scene_create(nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_scene_fix(nullptr, "bottom") == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_mesh_read("x.msh", 1.0, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_mesh_extent(nullptr, nullptr, nullptr, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_tissue_create(nullptr, nullptr, nullptr, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_tissue_report(nullptr, nullptr, 0, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_tissue_reset(nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_tissue_set_pose(nullptr, nullptr, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_tissue_cut(nullptr, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_create(nullptr, nullptr, 1, nullptr, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_tick(nullptr, nullptr, 1, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_reset(nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_work(nullptr, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_read_surface(nullptr, nullptr, nullptr, 0) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_snapshot(nullptr, nullptr) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_last_error(nullptr) == PALPATE_INVALID_ARGUMENT);
  palpate_mesh_destroy(nullptr);
  palpate_scene_destroy(nullptr);
  palpate_tissue_destroy(nullptr);
  palpate_session_destroy(nullptr);

  const Given given;
  const MeshHandle mesh = given.mesh();
  CHECK(palpate_scene_fix(reinterpret_cast<palpate_scene*>(mesh.get()), "bottom") == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_tick(reinterpret_cast<palpate_session*>(mesh.get()), nullptr, 1, nullptr) ==
        PALPATE_INVALID_ARGUMENT);
}

TEST_CASE("the C interface checks sizes and versions of structs", "[c]") {
  Given given;
  given.setup.struct_size -= 8;
  CHECK(given.refused().kind == PALPATE_INVALID_ARGUMENT);
  given = Given();
  given.setup.interface_version = 2;
  CHECK(given.refused().kind == PALPATE_INVALID_ARGUMENT);
  given = Given();
  given.material.struct_size = 0;
  CHECK(given.refused().kind == PALPATE_INVALID_ARGUMENT);

  // A newer program: a longer struct is accepted as long as what is unknown here is zero.
  struct Longer {
    palpate_setup known;
    double future;
  } longer{};
  given = Given();
  longer.known = given.setup;
  longer.known.materials = &given.material;
  longer.known.struct_size = sizeof(Longer);
  const MeshHandle mesh = given.mesh();
  const SceneHandle scene = given.scene();
  palpate_tissue* made = nullptr;
  REQUIRE(palpate_tissue_create(mesh.get(), scene.get(), &longer.known, &made) == PALPATE_OK);
  const TissueHandle tissue(made);
  longer.future = 1.0;
  CHECK(palpate_tissue_create(mesh.get(), scene.get(), &longer.known, &made) == PALPATE_INVALID_ARGUMENT);

  const SessionHandle session = session_of(tissue.get());
  palpate_tool_state state;
  palpate_tool_force force;
  PALPATE_INIT(&state);
  PALPATE_INIT(&force);
  CHECK(palpate_session_tick(session.get(), &state, 1, &force) == PALPATE_OK);
  state.struct_size += 8;
  CHECK(palpate_session_tick(session.get(), &state, 1, &force) == PALPATE_INVALID_ARGUMENT);
  PALPATE_INIT(&state);
  force.interface_version = 0;
  CHECK(palpate_session_tick(session.get(), &state, 1, &force) == PALPATE_INVALID_ARGUMENT);
  palpate_snapshot snapshot{};
  CHECK(palpate_session_snapshot(session.get(), &snapshot) == PALPATE_INVALID_ARGUMENT);
}

TEST_CASE("a session refuses tools and options without meaning, and a second session", "[c]") {
  const TissueHandle tissue = Given().tissue();
  palpate_session* made = nullptr;
  palpate_tool tool = sphere();
  CHECK(palpate_session_create(tissue.get(), &tool, 0, nullptr, &made) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_create(tissue.get(), &tool, 9, nullptr, &made) == PALPATE_INVALID_ARGUMENT);
  CHECK(palpate_session_create(tissue.get(), nullptr, 1, nullptr, &made) == PALPATE_INVALID_ARGUMENT);
  tool.kind = 7;
  CHECK(palpate_session_create(tissue.get(), &tool, 1, nullptr, &made) == PALPATE_INVALID_ARGUMENT);
  tool = sphere();
  tool.radius = -1.0;
  CHECK(palpate_session_create(tissue.get(), &tool, 1, nullptr, &made) == PALPATE_BAD_ARGUMENT);
  tool = sphere();
  tool.kind = PALPATE_BLADE;
  CHECK(palpate_session_create(tissue.get(), &tool, 1, nullptr, &made) == PALPATE_UNSUPPORTED);
  tool = sphere();
  palpate_session_options options;
  PALPATE_INIT(&options);
  options.stiffness = not_a_number;
  CHECK(palpate_session_create(tissue.get(), &tool, 1, &options, &made) == PALPATE_BAD_ARGUMENT);
  CHECK(made == nullptr);
  {
    const SessionHandle session = session_of(tissue.get());  // none of the refused ones claims the tissue
    CHECK(palpate_session_create(tissue.get(), &tool, 1, nullptr, &made) == PALPATE_INVALID_ARGUMENT);
  }
  CHECK(session_of(tissue.get()) != nullptr);
  const std::vector<double> sheet(12, 0.0);
  CHECK(palpate_tissue_cut(tissue.get(), sheet.data()) == PALPATE_UNSUPPORTED);
  const double position[3] = {0.0, 0.0, 0.0}, stretched[4] = {2.0, 0.0, 0.0, 0.0};
  CHECK(palpate_tissue_set_pose(tissue.get(), position, stretched) == PALPATE_BAD_ARGUMENT);
}

TEST_CASE("a pose that is not finite is flagged, and its force is finite", "[c]") {
  const TissueHandle tissue = Given().tissue();
  const SessionHandle session = session_of(tissue.get());
  palpate_tool_state state;
  palpate_tool_force force;
  PALPATE_INIT(&state);
  PALPATE_INIT(&force);
  for (const double bad : {not_a_number, std::numeric_limits<double>::infinity(), 1e300}) {
    state.position[1] = bad;
    REQUIRE(palpate_session_tick(session.get(), &state, 1, &force) == PALPATE_OK);
    CHECK((force.status & 1u) != 0);
    CHECK(std::string(palpate_status_name(0)) == "NonFiniteInput");
    for (const double f : force.force) CHECK(std::isfinite(f));
  }
}

TEST_CASE("each thread has its own last error, and success keeps it", "[c]") {
  CHECK(palpate_scene_fix(nullptr, "x") == PALPATE_INVALID_ARGUMENT);
  palpate_error other = -1;
  std::thread([&] { other = last().kind; }).join();
  CHECK(other == PALPATE_OK);
  const Given given;
  CHECK(given.scene() != nullptr);
  CHECK(last().kind == PALPATE_INVALID_ARGUMENT);
  CHECK(std::string(palpate_error_name(77)) == "unknown");
  CHECK(std::string(palpate_error_name(PALPATE_OUT_OF_MEMORY)) == "out_of_memory");
}

namespace {

/// Blocks of the heap that this thread has allocated and not released.
std::int64_t blocks() {
  const palpate::testing::HeapCalls calls = palpate::testing::detail::heap_calls_now();
  return static_cast<std::int64_t>(calls.allocations - calls.failed - calls.frees);
}

}  // namespace

TEST_CASE("a destroyed tissue and session leave nothing on the heap", "[c]") {
  Given given;
  given.setup.threads = 1;
  std::int64_t before = 0;
  for (int time = 0; time < 2; ++time) {  // the first time may make what remains until the program ends
    before = blocks();
    const TissueHandle tissue = given.tissue();
    const SessionHandle session = session_of(tissue.get());
    palpate_tool_state state;
    palpate_tool_force force;
    PALPATE_INIT(&state);
    PALPATE_INIT(&force);
    palpate_session_tick(session.get(), &state, 1, &force);
  }
  const std::int64_t after = blocks();
  CHECK(after == before);
}

TEST_CASE("memory that runs out is an error of the C interface, and everything is released", "[c]") {
  Given given;
  given.setup.threads = 1;
  const MeshHandle mesh = given.mesh();
  const SceneHandle scene = given.scene();
  given.setup.materials = &given.material;
  int failures = 0;
  for (const std::uint64_t number : {0u, 1u, 3u, 10u, 30u, 100u, 300u, 1000u, 3000u}) {
    auto* tissue = reinterpret_cast<palpate_tissue*>(1);
    palpate_error error = PALPATE_OK;
    const std::int64_t before = blocks();
    {
      const palpate::testing::FailingHeap heap(number);
      error = palpate_tissue_create(mesh.get(), scene.get(), &given.setup, &tissue);
    }
    if (error == PALPATE_OK) {  // it made fewer allocations, or does without this one
      palpate_tissue_destroy(tissue);
      continue;
    }
    const std::int64_t after = blocks();
    CAPTURE(number);
    CHECK(after == before);
    CHECK(error == PALPATE_OUT_OF_MEMORY);
    CHECK(tissue == nullptr);
    CHECK(last().kind == PALPATE_OUT_OF_MEMORY);
    ++failures;
  }
  if (palpate::testing::allocations_are_counted()) CHECK(failures > 5);
}
