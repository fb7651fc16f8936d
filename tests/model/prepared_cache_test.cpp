// The cache file of a prepared model: same results, and every difference is named.
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

#include "model/cache_folder.hpp"

using namespace test;

namespace {

constexpr std::array cacheable{PolicyName::sparse_cholesky,    PolicyName::selective_inverse,
                               PolicyName::condensed_inverse,  PolicyName::condensed_float,
                               PolicyName::condensed_cholesky, PolicyName::condensed_conjugate_gradient};

std::string text_of(const CacheReport& report) {
  std::ostringstream text;
  text << report;
  return text.str();
}

/// Inputs of a set-up, with defaults.
struct Setup {
  Mesh<Tet4> mesh = brick();
  Scene scene = brick_scene();
  Materials materials{{everywhere, {5e3, 0.3, 1000.0}}};
  PolicyName policy = PolicyName::condensed_inverse;

  std::unique_ptr<AnyModel> make(const SetupOptions& options = {}) const {
    return make_model(policy, mesh, scene, materials, options);
  }
};

}  // namespace

TEST_CASE("a cache file is named by any string, and its copies are used like it", "[model][cache]") {
  const CacheFolder folder;
  const std::string name = folder.cache().string();
  CHECK(SetupOptions{}.cache_file.empty());
  CHECK(SetupOptions{.cache_file = ""}.cache_file.empty());
  CHECK(SetupOptions{.cache_file = "a"}.cache_file.name() == "a");
  SetupOptions options;
  options.cache_file = name.c_str();
  CHECK(options.cache_file.name() == name);
  options.cache_file = std::string_view(name);
  CHECK(options.cache_file.name() == name);
  options = SetupOptions{.cache_file = name};
  const SetupOptions copy = options, moved = std::move(options);
  const std::string text = copy.cache_file;
  CHECK(text == name);
  CHECK(Setup{}.make(copy)->report().cache.written);
  CHECK(Setup{}.make(moved)->report().cache.read);
  options = copy;
  options.cache_file = {};
  CHECK(Setup{}.make(options)->report().cache.file.empty());
}

TEST_CASE("a model from a cache gives the results of the one that wrote it, bit for bit", "[model][cache][M14]") {
  for (PolicyName policy : cacheable) {
    INFO(name(policy));
    Setup setup;
    setup.scene = loaded(setup.scene);
    setup.policy = policy;
    const auto plain = setup.make();
    CHECK(plain->report().cache.file.empty());
    const std::vector<double> truth = answers(*plain);

    const CacheFolder folder;
    const auto first = setup.make(folder.options());
    CHECK(same_bits(answers(*first), truth));
    CHECK(first->report().cache.written);
    CHECK_FALSE(first->report().cache.read);
    CHECK(first->report().cache.bytes == fs::file_size(folder.cache()));
    CHECK(first->report().flags == plain->report().flags);
    CHECK_THAT(text_of(first->report().cache), contains("written " + folder.cache().string()));
    const Bytes file = bytes_of(folder.cache());

    const auto second = setup.make(folder.options());
    CHECK(same_bits(answers(*second), truth));
    CHECK(second->report().cache.read);
    CHECK_FALSE(second->report().cache.written);
    CHECK(second->report().cache.bytes == file.size());
    CHECK(second->report().solver_bytes == plain->report().solver_bytes);
    CHECK(second->report().flags == plain->report().flags);
    CHECK_THAT(text_of(second->report().cache), contains("read " + folder.cache().string()));
    CHECK(bytes_of(folder.cache()) == file);
    CHECK(folder.files() == 1);

    fs::remove(folder.cache());
    setup.make(folder.options());
    CHECK(bytes_of(folder.cache()) == file);  // the same set-up, the same bytes
  }
}

TEST_CASE("a model from a cache can be changed like any other", "[model][cache]") {
  const CacheFolder folder;
  Setup setup;
  setup.scene.prescribe(std::vector<NodeId>{3}, {2e-3, std::nullopt, std::nullopt});
  setup.make(folder.options());
  const auto plain = setup.make(), read = setup.make(folder.options());
  REQUIRE(read->report().cache.read);
  for (AnyModel* model : {plain.get(), read.get()}) model->set_conditions(loaded(brick_scene()));
  CHECK(same_bits(answers(*read), answers(*plain)));
}

TEST_CASE("changes that do not affect the stored numbers keep the cache valid", "[model][cache]") {
  const CacheFolder folder;
  Setup setup;
  setup.make(folder.options());
  SetupOptions options = folder.options();
  SECTION("loads") {
    setup.scene.gravity({0, 0, -9.81}).traction("x1", {5, 2, -10}).point_load("z1", {0, 0, -1});
  }
  SECTION("prescribed values") {
    setup.scene = Scene().prescribe("x0", {1e-3, 0.0, 0.0}).touch("z1").render("surface");
  }
  SECTION("density") {
    setup.materials[0].second.density = 1.0;
  }
  SECTION("rendered nodes") {
    setup.scene.render("x1");
  }
  SECTION("names of regions") {
    setup.mesh.region_names = {"liver"};
  }
  SECTION("slots") {
    options.compliance_slots = 3;
  }
  const auto model = setup.make(options);
  CHECK(model->report().cache.read);
  CHECK(same_bits(answers(*model), answers(*setup.make())));
}

TEST_CASE("a change of inputs is named, and the cache rebuilt", "[model][cache][extreme][C6]") {
  const CacheFolder folder;
  Setup setup;
  setup.make(folder.options());
  CacheMismatch expected = CacheMismatch::none;
  std::string word;
  SECTION("a node moved by a nanometre") {
    setup.mesh.positions[17].x() += 1e-9;
    expected = CacheMismatch::mesh, word = "the mesh differs";
  }
  SECTION("one element with rotated node order") {
    auto& e = setup.mesh.elements[11];
    std::rotate(e.begin(), e.begin() + 1, e.begin() + 3);  // even: the same tetrahedron
    expected = CacheMismatch::mesh, word = "the mesh differs";
  }
  SECTION("an element in another region") {
    setup.mesh.region_names = {"body", "tumour"};
    setup.mesh.regions.assign(60, 0);
    setup.mesh.regions[5] = 1;
    setup.materials = {{"body", {5e3, 0.3, 0.0}}, {"tumour", {5e3, 0.3, 0.0}}};
    expected = CacheMismatch::mesh, word = "the mesh differs, the material differs";  // the number of regions differs
  }
  SECTION("a stiffer material, in the last digit") {
    double& e = setup.materials[0].second.youngs_modulus;
    e = std::nextafter(e, 1e9);
    expected = CacheMismatch::material, word = "the material differs";
  }
  SECTION("another node constrained") {
    setup.scene.fix(std::vector<NodeId>{3});
    expected = CacheMismatch::conditions, word = "the conditions differ";
  }
  SECTION("another component constrained") {
    setup.scene.prescribe(std::vector<NodeId>{3}, {std::nullopt, 0.0, std::nullopt});
    expected = CacheMismatch::conditions, word = "the conditions differ";
  }
  SECTION("another touchable set") {
    setup.scene.touch("x1");
    expected = CacheMismatch::touched, word = "the touched set differs";
  }
  SECTION("other scalar") {
    setup.policy = PolicyName::condensed_float;
    expected = CacheMismatch::scalar, word = "the scalar differs (double in the file, float here)";
  }
  SECTION("other policy") {
    setup.policy = PolicyName::condensed_cholesky;
    expected = CacheMismatch::policy;
    word = "the policy differs (Condensed<SelectiveInverse> in the file, Condensed<DenseCholesky> here)";
  }
  SECTION("several things") {
    setup.scene.touch("x1");
    setup.materials[0].second.poisson_ratio = 0.2;
    expected = CacheMismatch::material, word = "the material differs, the touched set differs";
  }
  const auto model = setup.make(folder.options());
  const SetupReport& r = model->report();
  CHECK(r.cache.mismatch == expected);
  CHECK(r.cache.why == word);
  CHECK_FALSE(r.cache.read);
  CHECK(r.cache.written);
  CHECK(r.has(SetupFlag::cache_rejected));
  CHECK_FALSE(r.has(SetupFlag::cache_unwritten));
  CHECK(r.remarks.size() == static_cast<std::size_t>(std::popcount(r.flags)));
  CHECK_THAT(text_of(r.cache), contains("rebuilt because " + word));
  CHECK(same_bits(answers(*model), answers(*setup.make())));
  const auto again = setup.make(folder.options());
  CHECK(again->report().cache.read);
  CHECK(same_bits(answers(*again), answers(*setup.make())));
}

TEST_CASE("an element with other quadrature points is another element", "[model][cache][extreme][C6]") {
  struct FinerTet4 : Tet4 {  // the same stiffness up to rounding, from four points instead of one
    using Quadrature = TetrahedronRule<2>;
  };
  CHECK(detail::hash_of_element<Tet4>() != detail::hash_of_element<FinerTet4>());
  detail::CacheKey here, file;
  std::string why;
  CHECK(detail::compare(file, here, why) == CacheMismatch::none);
  file.element = 1;
  CHECK(detail::compare(file, here, why) == CacheMismatch::element);
  CHECK(why == "the element differs");
}

TEST_CASE("a solver with nothing to store is reported", "[model][cache]") {
  for (PolicyName policy : {PolicyName::conjugate_gradient, PolicyName::matrix_free_conjugate_gradient}) {
    const CacheFolder folder;
    Setup setup;
    setup.policy = policy;
    const auto model = setup.make(folder.options());
    CHECK_FALSE(model->report().cache.supported);
    CHECK(model->report().flags == 0);
    CHECK(folder.files() == 0);
    CHECK_THAT(text_of(model->report().cache), contains("nothing to store"));
  }
}

TEST_CASE("caches of models with no touchable or no free nodes", "[model][cache]") {
  for (PolicyName policy : cacheable)
    for (const Scene& scene : {Scene().fix("x0"), Scene().fix("surface").fix(std::vector<NodeId>{17, 18}),
                               Scene().fix("x0").fix("z1").touch("z1")}) {
      INFO(name(policy));
      const CacheFolder folder;
      Setup setup;
      setup.policy = policy;
      setup.scene = scene;
      const auto first = setup.make(folder.options()), second = setup.make(folder.options());
      CHECK(first->report().cache.written);
      CHECK(second->report().cache.read);
      CHECK(same_bits(answers(*first), answers(*second)));
    }
}

TEST_CASE("a refused or cancelled set-up leaves no cache and no temporary files", "[model][cache][progress]") {
  const CacheFolder folder;
  Setup setup;
  int calls = 0, stop_at = -1;
  SetupOptions options = folder.options();
  options.progress = [&](const Progress&) { return calls++ != stop_at; };
  setup.make(options);
  const Bytes good = bytes_of(folder.cache());
  const int all = calls;
  for (stop_at = 0; stop_at < all; ++stop_at) {
    calls = 0;
    fs::remove(folder.cache());
    CHECK_REFUSED(SetupErrorKind::cancelled, setup.make(options));
    CHECK((folder.files() == 0 || (folder.files() == 1 && bytes_of(folder.cache()) == good)));
  }
  fs::remove(folder.cache());
  setup.scene = Scene().touch("z1");
  CHECK_REFUSED(SetupErrorKind::unconstrained, setup.make(folder.options()));
  CHECK(folder.files() == 0);
}

TEST_CASE("the memory limit applies with a cache", "[model][cache][memory][extreme][B10]") {
  for (PolicyName policy : cacheable) {
    INFO(name(policy));
    const CacheFolder folder;
    Setup setup;
    setup.policy = policy;
    setup.make(folder.options());
    const Bytes good = bytes_of(folder.cache());
    SetupOptions options = folder.options();
    options.memory_limit = 2000;
    CHECK_REFUSED(SetupErrorKind::too_large, setup.make(options));
    CHECK(bytes_of(folder.cache()) == good);
  }
}

TEST_CASE("simultaneous writers leave a file that is valid for one of them", "[model][cache][extreme][C6]") {
  const CacheFolder folder;
  std::array<Setup, 2> setups;
  setups[1].materials[0].second.youngs_modulus = 1e4;  // each rejects what the other wrote
  const std::array truths{answers(*setups[0].make()), answers(*setups[1].make())};
  std::array<int, 2> wrong{}, unwritten{};
  {
    std::array<std::thread, 2> threads;
    for (std::size_t t = 0; t < 2; ++t)
      threads[t] = std::thread([&, t] {
        for (int i = 0; i < 40; ++i) {
          const auto model = setups[t].make(folder.options());
          const auto& u = model->displacement();
          if (std::memcmp(u.data(), truths[t].data(), static_cast<std::size_t>(u.size()) * sizeof(double)) != 0)
            ++wrong[t];
          if (!model->report().cache.read && !model->report().cache.written) ++unwritten[t];
        }
      });
    for (std::thread& t : threads) t.join();
  }
  CHECK(wrong == std::array{0, 0});
  CHECK(unwritten == std::array{0, 0});
  CHECK(folder.files() == 1);
  const auto one = setups[0].make(folder.options());  // reads, or rebuilds because of the material; nothing is damaged
  CHECK((one->report().cache.read || one->report().cache.mismatch == CacheMismatch::material));
  CHECK(same_bits(answers(*one), truths[0]));
}
