// Cache files that are damaged, foreign, forged or cannot be written: never a failure, never a wrong result.
#include <algorithm>
#include <sstream>

#include "model/cache_folder.hpp"

#if defined(__linux__)
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#endif

using namespace test;

namespace {

constexpr std::size_t header_size = sizeof(detail::CacheHeader), word = sizeof(std::uint64_t);

/// A tiny model whose cache file is tampered with.
class Tampered {
 public:
  explicit Tampered(PolicyName policy = PolicyName::condensed_inverse)
      : policy_(policy), truth_(make({})->displacement()) {
    make(folder.options());
    good = bytes_of(folder.cache());
  }
  std::unique_ptr<AnyModel> make(const SetupOptions& options) const {
    return make_model(policy_, two_cells(), two_cells_scene(), liver, options);
  }
  /// Report of a set-up with a file of these bytes. The results must be right, a bad file must be replaced by a good
  /// one, and a foreign file must be left unchanged; `mistakes` counts violations.
  CacheReport report_on(const Bytes& bytes) {
    write_bytes(folder.cache(), bytes);
    const auto model = make(folder.options());
    const CacheReport r = model->report().cache;
    const bool foreign = r.mismatch == CacheMismatch::foreign;
    bool right = model->displacement() == truth_ && !r.read && r.mismatch != CacheMismatch::none && !r.why.empty();
    right = right && model->report().has(SetupFlag::cache_rejected);
    right = right && bytes_of(folder.cache()) == (foreign ? bytes : good) && r.written == !foreign;
    right = right && model->report().has(SetupFlag::cache_unwritten) == foreign;
    if (!right) ++mistakes;
    return r;
  }
  CacheMismatch mismatch_of(const Bytes& bytes) { return report_on(bytes).mismatch; }

  /// The good file with a changed header, as another version of the library would have written it.
  template <class Change>
  Bytes with_header(Change change) const {
    detail::CacheHeader header;
    std::memcpy(&header, good.data(), header_size);
    change(header);
    header.hash = header.right_hash();
    Bytes bytes = good;
    std::memcpy(bytes.data(), &header, header_size);
    return bytes;
  }

  CacheFolder folder;
  Bytes good;
  int mistakes = 0;

 private:
  PolicyName policy_;
  VectorX truth_;
};

template <class T>
T value_at(const Bytes& bytes, std::size_t at) {
  T v;
  std::memcpy(&v, bytes.data() + at, sizeof v);
  return v;
}
template <class T>
void set_value(Bytes& bytes, std::size_t at, T v) {
  std::memcpy(bytes.data() + at, &v, sizeof v);
}

// The payload of a condensed system: condition, order, count, factor, count, matrix, hash.
constexpr std::size_t order_at = header_size + word, count_at = order_at + word, factor_at = count_at + word;

/// Writes the payload of a condensed system with a right hash, as a faulty program would: the factor times `factor`.
void forge(const fs::path& path, const Bytes& good, std::uint64_t order, double factor) {
  const auto count = value_at<std::uint64_t>(good, count_at);
  std::vector<double> interior(count), matrix;
  std::memcpy(interior.data(), good.data() + factor_at, count * word);
  for (double& v : interior) v *= factor;
  const std::size_t matrix_at = factor_at + count * word;
  matrix.resize(value_at<std::uint64_t>(good, matrix_at));
  std::memcpy(matrix.data(), good.data() + matrix_at + word, matrix.size() * word);
  const detail::File out(std::fopen(path.c_str(), "wb"));
  REQUIRE(std::fwrite(good.data(), 1, header_size, out.get()) == header_size);
  BinaryWriter writer(out.get());
  writer.value(value_at<double>(good, header_size));
  writer.value(order);
  writer.array(std::span<const double>(interior));
  writer.array(std::span<const double>(matrix));
  writer.value(writer.digest());
}

#if defined(__linux__)
/// Largest address space so far [kB].
std::size_t peak_kilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;)
    if (std::size_t value = 0; key == "VmPeak:" && status >> value) return value;
  return 0;
}
#endif

}  // namespace

TEST_CASE("every flipped bit of a cache is detected", "[model][cache][extreme][C6]") {
  Tampered t;
  std::array<int, 32> found{};
  for (std::size_t bit = 0; bit < 8 * t.good.size(); ++bit) {
    Bytes bytes = t.good;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    const CacheMismatch m = t.mismatch_of(bytes);
    ++found[static_cast<std::size_t>(m)];
    const std::size_t at = bit / 8;
    const CacheMismatch expected = at < 8                            ? CacheMismatch::foreign
                                   : at < 16                         ? CacheMismatch::byte_order
                                   : at < 32                         ? CacheMismatch::version
                                   : at < header_size                ? CacheMismatch::header
                                   : at >= order_at && at < count_at ? CacheMismatch::elimination
                                                                     : CacheMismatch::payload;
    if (m != expected) ++t.mistakes;
  }
  CHECK(t.mistakes == 0);
  CHECK(found[static_cast<std::size_t>(CacheMismatch::payload)] > 8000);
  CHECK(t.folder.files() == 1);
}

TEST_CASE("truncation of a cache to any length is detected", "[model][cache][extreme][C6]") {
  Tampered t;
  for (std::size_t size = 0; size < t.good.size(); ++size)
    if (t.mismatch_of(Bytes(t.good.begin(), t.good.begin() + static_cast<std::ptrdiff_t>(size))) !=
        CacheMismatch::truncated)
      ++t.mistakes;
  CHECK(t.mistakes == 0);
  for (std::size_t more : {1u, 8u, 5000u}) {
    Bytes longer = t.good;
    longer.resize(t.good.size() + more);
    CHECK(t.mismatch_of(longer) == CacheMismatch::payload);
  }
  CHECK(t.mistakes == 0);
}

TEST_CASE("random damage of the cache of every policy is detected", "[model][cache][extreme][C6]") {
  for (PolicyName policy : {PolicyName::sparse_cholesky, PolicyName::selective_inverse, PolicyName::condensed_float,
                            PolicyName::condensed_cholesky, PolicyName::condensed_conjugate_gradient}) {
    INFO(name(policy));
    Tampered t(policy);
    testing::Random random(271828);
    for (int i = 0; i < 100; ++i) {
      Bytes bytes = t.good;
      const auto size = static_cast<double>(bytes.size());
      for (int n = 0; n <= i % 5; ++n) {  // changes some bytes
        auto& byte = bytes[static_cast<std::size_t>(random.uniform(0.0, size * 0.999999))];
        byte = static_cast<char>(byte ^ static_cast<char>(1 + static_cast<int>(random.uniform(0.0, 254.9))));
      }
      if (bytes != t.good) t.mismatch_of(bytes);
    }
    CHECK(t.mistakes == 0);
  }
}

TEST_CASE("caches of other versions and other machines are rejected", "[model][cache][extreme][C6]") {
  Tampered t;
  const auto why = [&](const Bytes& bytes, CacheMismatch expected) {
    const CacheReport r = t.report_on(bytes);
    CHECK(static_cast<int>(r.mismatch) == static_cast<int>(expected));
    return r.why;
  };
  CHECK_THAT(why(t.with_header([](detail::CacheHeader& h) { ++h.version; }), CacheMismatch::version),
             contains("library " + std::to_string(PALPATE_VERSION + 1) + " in the file"));
  CHECK_THAT(why(t.with_header([](detail::CacheHeader& h) { ++h.layout; }), CacheMismatch::version),
             contains("layout " + std::to_string(detail::CacheHeader::our_layout + 1) + " in the file, " +
                      std::to_string(detail::CacheHeader::our_layout) + " here"));
  CHECK_THAT(why(t.with_header([](detail::CacheHeader& h) { h.key.stiffness ^= 1; }), CacheMismatch::stiffness),
             contains("the stiffness differs"));
  CHECK_THAT(why(t.with_header([](detail::CacheHeader& h) { h.key.element ^= 1; }), CacheMismatch::element),
             contains("the element differs"));

  Bytes swapped = t.good;  // as a machine of the other endianness writes: every word but the magic and the name
  for (std::size_t at = 8; at + word <= swapped.size(); at += word)
    if (at < 32 || at >= 96)
      std::reverse(swapped.begin() + static_cast<std::ptrdiff_t>(at),
                   swapped.begin() + static_cast<std::ptrdiff_t>(at + word));
  CHECK_THAT(why(swapped, CacheMismatch::byte_order), contains("byte order"));
  CHECK(t.mistakes == 0);
}

TEST_CASE("a cache with right hashes and wrong numbers is rejected", "[model][cache][extreme][C6]") {
  Tampered t;
  const auto order = value_at<std::uint64_t>(t.good, order_at);
  forge(t.folder.cache(), t.good, order, 1.0);
  REQUIRE(bytes_of(t.folder.cache()) == t.good);  // `forge` reproduces the format
  forge(t.folder.cache(), t.good, order, 2.0);
  CHECK(t.mismatch_of(bytes_of(t.folder.cache())) == CacheMismatch::answers);
  forge(t.folder.cache(), t.good, order, std::numeric_limits<double>::quiet_NaN());
  CHECK(t.mismatch_of(bytes_of(t.folder.cache())) == CacheMismatch::answers);
  forge(t.folder.cache(), t.good, order + 1, 1.0);
  CHECK(t.mismatch_of(bytes_of(t.folder.cache())) == CacheMismatch::elimination);
  CHECK(t.mistakes == 0);
}

TEST_CASE("wrong counts in a cache allocate nothing", "[model][cache][memory][extreme][C6]") {
  Tampered t;
  const auto count = value_at<std::uint64_t>(t.good, count_at);
  const std::size_t second_at = factor_at + count * word;
#if defined(__linux__)
  const std::size_t before = peak_kilobytes();
#endif
  for (std::size_t at : {count_at, second_at})
    for (std::uint64_t lie : {std::uint64_t{0}, count + 1, std::uint64_t{1} << 28, std::uint64_t{1} << 40,
                              std::uint64_t{1} << 61, ~std::uint64_t{0}}) {
      Bytes bytes = t.good;
      set_value(bytes, at, lie);
      CHECK(t.mismatch_of(bytes) == CacheMismatch::payload);
    }
  CHECK(t.mistakes == 0);
#if defined(__linux__)
  REQUIRE(before > 0);
  CHECK(peak_kilobytes() < before + (std::size_t{1} << 20));  // 1 << 28 doubles would be 2 GiB more
#endif
}

TEST_CASE("a file that is not a cache is never overwritten", "[model][cache][extreme][C6]") {
  Tampered t;
  const std::string mesh = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  const CacheReport r = t.report_on(Bytes(mesh.begin(), mesh.end()));
  CHECK(r.mismatch == CacheMismatch::foreign);
  CHECK_THAT(r.problem, contains("left alone"));
  CHECK(t.mistakes == 0);
  CHECK(t.folder.files() == 1);
#if defined(__linux__)
  fs::remove(t.folder.cache());
  REQUIRE(::mkfifo(t.folder.cache().c_str(), 0600) == 0);  // opening it would block for ever
  const auto model = t.make(t.folder.options());
  CHECK(model->report().cache.mismatch == CacheMismatch::foreign);
  CHECK(fs::is_fifo(t.folder.cache()));
#endif
}

TEST_CASE("a cache that cannot be written is only reported", "[model][cache][extreme][C6]") {
  const CacheFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  fs::create_directory(folder.path() / "folder");
  const auto truth = make_model(PolicyName::condensed_inverse, two_cells(), two_cells_scene(), liver)->displacement();
  const auto report_of = [&](const fs::path& path) {
    SetupOptions options;
    options.cache_file = path.string();
    const auto model = make_model(PolicyName::condensed_inverse, two_cells(), two_cells_scene(), liver, options);
    CHECK(model->displacement() == truth);
    CHECK_FALSE(model->report().cache.read);
    CHECK_FALSE(model->report().cache.written);
    CHECK(model->report().has(SetupFlag::cache_unwritten));
    CHECK_FALSE(model->report().cache.problem.empty());
    std::ostringstream text;
    text << model->report();
    CHECK_THAT(text.str(), contains("could not be written because " + model->report().cache.problem));
    return model->report().cache;
  };
  CHECK(report_of(folder.path() / "no" / "such.palpate").mismatch == CacheMismatch::none);
  CHECK(report_of(folder.path() / "file" / "below.palpate").mismatch == CacheMismatch::none);
  CHECK(report_of(folder.path() / "folder").mismatch == CacheMismatch::foreign);
  CHECK(fs::is_directory(folder.path() / "folder"));
#if defined(__linux__)
  if (::geteuid() != 0) {  // root may write anywhere
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    report_of(folder.cache());
    fs::permissions(folder.path(), fs::perms::owner_all);
  }
  // A full disk, as a limit on the size of files.
  ::rlimit limit{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &limit) == 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  for (::rlim_t size : {0u, 100u, 1000u}) {
    const ::rlimit tight{size, limit.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &tight) == 0);
    const CacheReport r = report_of(folder.cache());
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
    CHECK_FALSE(fs::exists(folder.cache()));
    CHECK_THAT(r.problem, contains("large"));
  }
  std::signal(SIGXFSZ, handler);
#endif
  CHECK(folder.files() == 2);  // no temporary files left
}
