// The C interface of palpate as a Python module. Arrays are numpy views of memory that the session owns: no copy. The
// interpreter is free (no GIL) during set-up and ticks.
#include <palpate/c/palpate.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;
using namespace pybind11::literals;

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

py::handle setup_error;  // the class palpate.SetupError

/// Raises palpate.SetupError.
[[noreturn]] void raise(const std::string& kind, const std::string& text, const std::string& hint,
                        const py::object& ids, std::int64_t count, double value, double threshold) {
  py::object error = setup_error(hint.empty() ? text : text + ". " + hint);
  error.attr("kind") = kind;
  error.attr("ids") = ids;
  error.attr("count") = count;
  error.attr("value") = value;
  error.attr("threshold") = threshold;
  error.attr("hint") = hint;
  PyErr_SetObject(setup_error.ptr(), error.ptr());
  throw py::error_already_set();
}

/// As np.asarray. Refuses an array of numbers of another kind: a cast would turn a mask into the numbers 0 and 1.
py::array as_array(const py::object& given, const char* kinds, const std::string& name, const char* hint) {
  py::array array = py::array::ensure(given);
  if (!array) throw py::type_error(name + " is no array of numbers");
  if (array.size() > 0 && std::string(kinds).find(array.dtype().kind()) == std::string::npos)
    throw py::type_error(name + " is an array of " + std::string(py::str(array.dtype())) + ": " + hint);
  return array;
}

/// Real numbers of any type.
Doubles doubles(const py::object& given, const std::string& name) {
  return Doubles(as_array(given, "iuf", name, "give real numbers"));
}

/// Integers of any type, each of which 32 bits hold. Throws SetupError(index_out_of_range) for others.
Integers integers(const py::object& given, const std::string& name) {
  const py::array array = as_array(given, "iu", name, "give integers; for a mask np.flatnonzero(mask)");
  const Integers cast(array);
  const py::object same = array.attr("__eq__")(cast);
  if (array.size() == 0 || same.attr("all")().cast<bool>()) return cast;
  const py::object first = array.attr("flat")[same.attr("argmin")()].attr("item")();
  py::list ids;
  ids.append(first);
  raise("index_out_of_range", name + " contains " + std::string(py::str(first)) + ", which 32 bits do not hold", "",
        ids, 1, first.cast<double>(), 2147483647.0);
}

[[noreturn]] void raise_last() {
  palpate_error_info info;
  PALPATE_INIT(&info);
  palpate_last_error(&info);
  raise(palpate_error_name(info.kind), info.text, info.hint,
        py::cast(std::vector<std::int64_t>(info.ids, info.ids + info.id_count)), info.count, info.value,
        info.threshold);
}
void check(palpate_error error) {
  if (error != PALPATE_OK) raise_last();
}

template <auto destroy>
struct Destroy {
  template <class T>
  void operator()(T* handle) const {
    py::gil_scoped_release free;  // a background thread may have to end
    destroy(handle);
  }
};

class Mesh {
 public:
  static std::unique_ptr<Mesh> read(const std::string& path, double scale) {
    auto made = std::make_unique<Mesh>();
    palpate_mesh* mesh = nullptr;
    palpate_error error;
    {
      py::gil_scoped_release free;
      error = palpate_mesh_read(path.c_str(), scale, &mesh);
    }
    check(error);
    made->handle_.reset(mesh);
    return made;
  }
  Mesh() = default;
  Mesh(const py::object& given_positions, const py::object& given_cells, const py::object& given_regions) {
    const Doubles positions = doubles(given_positions, "positions");
    const Integers cells = integers(given_cells, "cells");
    std::optional<Integers> regions;
    if (!given_regions.is_none()) regions = integers(given_regions, "regions");
    if (positions.ndim() != 2 || positions.shape(1) != 3) throw py::value_error("positions must have shape (n, 3)");
    if (cells.ndim() != 2) throw py::value_error("cells must have shape (m, nodes per cell)");
    if (regions && regions->size() != cells.shape(0)) throw py::value_error("regions must have one number per cell");
    palpate_mesh* mesh = nullptr;
    check(palpate_mesh_from_arrays(positions.data(), static_cast<std::size_t>(positions.shape(0)), cells.data(),
                                   static_cast<std::size_t>(cells.shape(0)), static_cast<int>(cells.shape(1)),
                                   regions ? regions->data() : nullptr, &mesh));
    handle_.reset(mesh);
  }
  void add_group(const std::string& name, const py::object& given) {
    const Integers nodes = integers(given, "nodes");
    check(palpate_mesh_add_group(handle_.get(), name.c_str(), nodes.data(), static_cast<std::size_t>(nodes.size())));
  }
  void add_group_in_box(const std::string& name, const std::array<double, 3>& low, const std::array<double, 3>& high) {
    check(palpate_mesh_add_group_in_box(handle_.get(), name.c_str(), low.data(), high.data()));
  }
  std::size_t node_count() const {
    std::size_t count = 0;
    check(palpate_mesh_extent(handle_.get(), &count, nullptr, nullptr));
    return count;
  }
  palpate_mesh* get() const { return handle_.get(); }

 private:
  std::unique_ptr<palpate_mesh, Destroy<palpate_mesh_destroy>> handle_;
};

class Scene {
 public:
  Scene() {
    palpate_scene* scene = nullptr;
    check(palpate_scene_create(&scene));
    handle_.reset(scene);
  }
  Scene& fix(const std::string& group) { return done(palpate_scene_fix(get(), group.c_str())); }
  Scene& prescribe(const std::string& group, const std::array<std::optional<double>, 3>& u) {
    std::array<double, 3> values;
    for (std::size_t c = 0; c < 3; ++c) values[c] = u[c].value_or(std::nan(""));
    return done(palpate_scene_prescribe(get(), group.c_str(), values.data()));
  }
  Scene& traction(const std::string& group, const std::array<double, 3>& t) {
    return done(palpate_scene_traction(get(), group.c_str(), t.data()));
  }
  Scene& pressure(const std::string& group, double p) { return done(palpate_scene_pressure(get(), group.c_str(), p)); }
  Scene& point_load(const std::string& group, const std::array<double, 3>& f) {
    return done(palpate_scene_point_load(get(), group.c_str(), f.data()));
  }
  Scene& gravity(const std::array<double, 3>& g) { return done(palpate_scene_gravity(get(), g.data())); }
  Scene& touch(const std::string& group, double radius) {
    return done(palpate_scene_touch(get(), group.c_str(), radius));
  }
  Scene& render(const std::string& group) { return done(palpate_scene_render(get(), group.c_str())); }
  palpate_scene* get() const { return handle_.get(); }

 private:
  Scene& done(palpate_error error) {
    check(error);
    return *this;
  }
  std::unique_ptr<palpate_scene, Destroy<palpate_scene_destroy>> handle_;
};

struct Material {
  double youngs_modulus, poisson_ratio, density;
  std::string region;
};

/// Progress of a set-up: calls Python about every 10 ms, and looks for Ctrl-C.
struct Watch {
  py::object callback;
  std::exception_ptr thrown{};

  static int32_t call(void* user, const char* stage, double fraction) {
    auto& watch = *static_cast<Watch*>(user);
    const py::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (watch.callback.is_none()) return 0;
      const py::object result = watch.callback(stage, fraction);
      return result.is_none() || result.cast<bool>() ? 0 : 1;
    } catch (...) {
      watch.thrown = std::current_exception();
      return 1;
    }
  }
};

class Tissue {
 public:
  Tissue(const Mesh& mesh, const Scene& scene, const std::string& policy, const std::vector<Material>& materials,
         const py::object& progress, int threads, bool repair, int force_error_places, std::uint64_t memory_limit,
         bool quasi_static, double step, double mass_damping, const std::optional<std::string>& cache_file) {
    std::vector<palpate_material> given(materials.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
      PALPATE_INIT(&given[i]);
      given[i].region = materials[i].region.c_str();
      given[i].youngs_modulus = materials[i].youngs_modulus;
      given[i].poisson_ratio = materials[i].poisson_ratio;
      given[i].density = materials[i].density;
    }
    Watch watch{progress};
    palpate_setup setup;
    PALPATE_INIT(&setup);
    setup.policy = policy.c_str();
    setup.materials = given.data();
    setup.material_count = given.size();
    setup.progress = &Watch::call;
    setup.progress_user = &watch;
    setup.memory_limit = memory_limit;
    setup.threads = threads;
    setup.repair = repair;
    setup.force_error_places = force_error_places;
    setup.quasi_static = quasi_static;
    setup.step = step;
    setup.mass_damping = mass_damping;
    setup.cache_file = cache_file ? cache_file->c_str() : nullptr;
    palpate_tissue* tissue = nullptr;
    palpate_error error;
    {
      py::gil_scoped_release free;
      error = palpate_tissue_create(mesh.get(), scene.get(), &setup, &tissue);
    }
    if (watch.thrown) {
      palpate_tissue_destroy(tissue);
      std::rethrow_exception(watch.thrown);
    }
    check(error);
    handle_.reset(tissue);
    nodes_ = mesh.node_count();
  }
  std::string report() const {
    std::size_t length = 0;
    check(palpate_tissue_report(get(), nullptr, 0, &length));
    std::string text(length, '\0');
    check(palpate_tissue_report(get(), text.data(), length + 1, &length));
    return text;
  }
  py::array_t<double> displacement() const {
    py::array_t<double> u({static_cast<py::ssize_t>(nodes_), py::ssize_t{3}});
    check(palpate_tissue_displacement(get(), u.mutable_data(), 3 * nodes_));
    return u;
  }
  void set_pose(const std::array<double, 3>& position, const std::array<double, 4>& quaternion) {
    check(palpate_tissue_set_pose(get(), position.data(), quaternion.data()));
  }
  void set_gravity(const std::array<double, 3>& gravity) { check(palpate_tissue_set_gravity(get(), gravity.data())); }
  void reset() { check(palpate_tissue_reset(get())); }
  void cut(const std::array<std::array<double, 3>, 4>& sheet) { check(palpate_tissue_cut(get(), sheet[0].data())); }
  palpate_tissue* get() const { return handle_.get(); }

 private:
  std::unique_ptr<palpate_tissue, Destroy<palpate_tissue_destroy>> handle_;
  std::size_t nodes_ = 0;
};

palpate_tool sphere(double radius) {
  palpate_tool tool;
  PALPATE_INIT(&tool);
  tool.radius = radius;
  return tool;
}
palpate_tool capsule(double radius, double half_length, const std::array<double, 3>& axis) {
  palpate_tool tool = sphere(radius);
  tool.kind = PALPATE_CAPSULE;
  tool.half_length = half_length;
  std::copy(axis.begin(), axis.end(), tool.axis);
  return tool;
}
palpate_tool blade(const std::array<double, 3>& edge, double toughness, double cut_spacing) {
  palpate_tool tool = sphere(0.0);
  tool.kind = PALPATE_BLADE;
  std::copy(edge.begin(), edge.end(), tool.edge);
  tool.toughness = toughness;
  tool.cut_spacing = cut_spacing;
  return tool;
}

class Session {
 public:
  Session(const Tissue& tissue, const std::vector<palpate_tool>& tools, double rate, double peak_force,
          double stiffness, double friction, bool limit_energy, bool manual_work)
      : states_(tools.size()), forces_(tools.size()) {
    for (auto& state : states_) PALPATE_INIT(&state);
    for (auto& force : forces_) PALPATE_INIT(&force);
    palpate_session_options options;
    PALPATE_INIT(&options);
    options.rate = rate;
    options.peak_force = peak_force;
    options.stiffness = stiffness;
    options.friction = friction;
    options.limit_energy = limit_energy;
    options.manual_work = manual_work;
    palpate_session* session = nullptr;
    check(palpate_session_create(tissue.get(), tools.data(), tools.size(), &options, &session));
    handle_.reset(session);
    resize();
  }

  /// One tick; only for a session with one tool. The results are in the views.
  std::uint32_t tick(double x, double y, double z, double time) {
    if (states_.size() != 1) throw py::value_error("tick(x, y, z, time) is for one tool: use tick_tools, or run");
    const std::array<double, 3> position{x, y, z};
    check(tick_at(position.data(), time));
    return forces_[0].status;
  }
  /// One tick of all tools, a row each: returns their statuses.
  std::vector<std::uint32_t> tick_tools(const py::object& given, double time) {
    const Doubles positions = doubles(given, "positions");
    const auto tools = static_cast<py::ssize_t>(states_.size());
    if (positions.ndim() != 2 || positions.shape(0) != tools || positions.shape(1) != 3)
      throw py::value_error("positions must have shape (" + std::to_string(tools) + ", 3), a row per tool");
    check(tick_at(positions.data(), time));
    std::vector<std::uint32_t> statuses;
    for (const palpate_tool_force& f : forces_) statuses.push_back(f.status);
    return statuses;
  }

  /// Ticks along a path, one row per tick, or with several tools one row per tick and tool: returns forces and contact
  /// forces.
  std::pair<py::array_t<double>, py::array_t<double>> run(const py::object& given_positions,
                                                          const py::object& given_times) {
    const Doubles positions = doubles(given_positions, "positions"), times = doubles(given_times, "times");
    const std::size_t tools = states_.size();
    const bool one_row = tools == 1 && positions.ndim() == 2 && positions.shape(1) == 3;
    if (!one_row &&
        (positions.ndim() != 3 || positions.shape(1) != static_cast<py::ssize_t>(tools) || positions.shape(2) != 3))
      throw py::value_error(tools == 1 ? "positions must have shape (n, 3)"
                                       : "positions must have shape (n, " + std::to_string(tools) + ", 3)");
    if (times.size() != positions.shape(0)) throw py::value_error("times must have one number per tick");
    const auto n = static_cast<std::size_t>(positions.shape(0));
    py::array_t<double> forces(positions.request().shape), contact(forces.request().shape);
    const double* x = positions.data();
    const double* t = times.data();
    double *f = forces.mutable_data(), *c = contact.mutable_data();
    palpate_error error = PALPATE_OK;
    for (std::size_t first = 0; first < n && error == PALPATE_OK; first += 4096) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      const py::gil_scoped_release free;
      for (std::size_t i = first; i < std::min(n, first + 4096) && error == PALPATE_OK; ++i) {
        error = tick_at(x + 3 * tools * i, t[i]);
        for (std::size_t k = 0; k < tools; ++k) {
          std::copy_n(forces_[k].force, 3, f + 3 * (tools * i + k));
          std::copy_n(forces_[k].contact_force, 3, c + 3 * (tools * i + k));
        }
      }
    }
    check(error);
    return {forces, contact};
  }

  void reset() { check(palpate_session_reset(get())); }
  bool work() {
    std::int32_t worked = 0;
    palpate_error error;
    {
      py::gil_scoped_release free;
      error = palpate_session_work(get(), &worked);
    }
    check(error);
    return worked != 0;
  }
  void read_surface() {
    palpate_error error;
    {
      py::gil_scoped_release free;
      error = palpate_session_read_surface(get(), vertices_->data(), normals_->data(), vertices_->size());
    }
    check(error);
  }
  /// Views that were taken before keep the old arrays.
  bool update_surface() {
    std::int32_t changed = 0;
    check(palpate_session_update_surface(get(), &changed));
    if (changed != 0) resize();
    return changed != 0;
  }
  py::array force(int tool) { return view3(forces_.at(static_cast<std::size_t>(tool)).force); }
  py::array contact_force(int tool) { return view3(forces_.at(static_cast<std::size_t>(tool)).contact_force); }
  std::uint32_t status(int tool) const { return forces_.at(static_cast<std::size_t>(tool)).status; }
  double error_bound(int tool) const { return forces_.at(static_cast<std::size_t>(tool)).error_bound; }
  py::array vertices() const { return view(vertices_); }
  py::array normals() const { return view(normals_); }
  py::array triangles() const { return view(triangles_); }

 private:
  /// One tick with the tools at these positions, x y z each.
  palpate_error tick_at(const double* positions, double time) noexcept {
    for (std::size_t k = 0; k < states_.size(); ++k) {
      std::copy_n(positions + 3 * k, 3, states_[k].position);
      states_[k].time = states_[k].now = time;
      states_[k].given = PALPATE_HAS_NOW;
    }
    return palpate_session_tick(get(), states_.data(), 1, forces_.data());
  }
  template <class T>
  static py::array view(const std::shared_ptr<std::vector<T>>& values) {
    const py::capsule owner(new std::shared_ptr<std::vector<T>>(values),
                            [](void* p) { delete static_cast<std::shared_ptr<std::vector<T>>*>(p); });
    return py::array_t<T>({static_cast<py::ssize_t>(values->size() / 3), py::ssize_t{3}}, values->data(), owner);
  }
  py::array view3(double* values) { return py::array_t<double>({py::ssize_t{3}}, values, py::cast(this)); }
  void resize() {
    std::size_t points = 0, triangles = 0;
    check(palpate_session_surface_size(get(), &points, &triangles));
    vertices_ = std::make_shared<std::vector<float>>(3 * points);
    normals_ = std::make_shared<std::vector<float>>(3 * points);
    triangles_ = std::make_shared<std::vector<std::int32_t>>(3 * triangles);
    check(palpate_session_triangles(get(), triangles_->data(), triangles_->size()));
  }
  palpate_session* get() const { return handle_.get(); }

  std::vector<palpate_tool_state> states_;
  std::vector<palpate_tool_force> forces_;  // never resized: views refer to its entries
  std::shared_ptr<std::vector<float>> vertices_, normals_;
  std::shared_ptr<std::vector<std::int32_t>> triangles_;
  std::unique_ptr<palpate_session, Destroy<palpate_session_destroy>> handle_;
};

std::vector<std::string> policies() {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < palpate_policy_count(); ++i) all.emplace_back(palpate_policy_name(i));
  return all;
}

std::vector<std::string> status_names(std::uint32_t status) {
  std::vector<std::string> names;
  for (int bit = 0; bit < palpate_status_count(); ++bit)
    if ((status >> bit & 1u) != 0) names.emplace_back(palpate_status_name(bit));
  return names;
}

}  // namespace

PYBIND11_MODULE(_palpate, m) {
  m.doc() = "Finite elements for haptics";
  setup_error = py::exception<std::runtime_error>(m, "SetupError").release();
  m.attr("__version__") = palpate_version();
  m.def("policies", &policies);
  m.def("status_names", &status_names, "status"_a);

  py::class_<Mesh>(m, "Mesh")
      .def(py::init<const py::object&, const py::object&, const py::object&>(), "positions"_a, "cells"_a,
           "regions"_a = py::none())
      .def_static("read", &Mesh::read, "path"_a, "scale"_a = 1.0)
      .def("add_group", &Mesh::add_group, "name"_a, "nodes"_a)
      .def("add_group_in_box", &Mesh::add_group_in_box, "name"_a, "low"_a, "high"_a)
      .def_property_readonly("node_count", &Mesh::node_count);

  constexpr auto self = py::return_value_policy::reference_internal;
  py::class_<Scene>(m, "Scene")
      .def(py::init<>())
      .def("fix", &Scene::fix, "group"_a, self)
      .def("prescribe", &Scene::prescribe, "group"_a, "displacement"_a, self)
      .def("traction", &Scene::traction, "group"_a, "traction"_a, self)
      .def("pressure", &Scene::pressure, "group"_a, "pressure"_a, self)
      .def("point_load", &Scene::point_load, "group"_a, "force"_a, self)
      .def("gravity", &Scene::gravity, "acceleration"_a, self)
      .def("touch", &Scene::touch, "group"_a, "radius"_a = 0.0, self)
      .def("render", &Scene::render, "group"_a, self);

  py::class_<Material>(m, "Material")
      .def(py::init([](double e, double nu, double rho, const std::string& region) {
             return Material{e, nu, rho, region};
           }),
           py::kw_only(), "youngs_modulus"_a, "poisson_ratio"_a, "density"_a = 0.0, "region"_a = "");

  py::class_<Tissue>(m, "Tissue")
      .def(py::init<const Mesh&, const Scene&, const std::string&, const std::vector<Material>&, const py::object&, int,
                    bool, int, std::uint64_t, bool, double, double, const std::optional<std::string>&>(),
           "mesh"_a, "scene"_a, "policy"_a, "materials"_a, py::kw_only(), "progress"_a = py::none(), "threads"_a = 0,
           "repair"_a = false, "force_error_places"_a = 0, "memory_limit"_a = 0, "quasi_static"_a = false,
           "step"_a = 0.0, "mass_damping"_a = 0.0, "cache_file"_a = py::none())
      .def("report_json", &Tissue::report)
      .def("displacement", &Tissue::displacement)
      .def("set_pose", &Tissue::set_pose, "position"_a, "quaternion"_a)
      .def("set_gravity", &Tissue::set_gravity, "gravity"_a)
      .def("reset", &Tissue::reset)
      .def("cut", &Tissue::cut, "sheet"_a);

  py::class_<palpate_tool>(m, "Tool");
  m.def("Sphere", &sphere, "radius"_a = 4e-3);
  m.def("Capsule", &capsule, "radius"_a, "half_length"_a, "axis"_a = std::array<double, 3>{0.0, 0.0, 1.0});
  m.def("Blade", &blade, "edge"_a, "toughness"_a = 100.0, "cut_spacing"_a = 1e-3);

  py::class_<Session>(m, "Session")
      .def(py::init<const Tissue&, const std::vector<palpate_tool>&, double, double, double, double, bool, bool>(),
           "tissue"_a, "tools"_a, py::kw_only(), "rate"_a = 0.0, "peak_force"_a = 0.0, "stiffness"_a = 0.0,
           "friction"_a = 0.0, "limit_energy"_a = false, "manual_work"_a = false)
      .def("tick", &Session::tick, "x"_a, "y"_a, "z"_a, "time"_a)
      .def("tick_tools", &Session::tick_tools, "positions"_a, "time"_a)
      .def("run", &Session::run, "positions"_a, "times"_a)
      .def("reset", &Session::reset)
      .def("work", &Session::work)
      .def("read_surface", &Session::read_surface)
      .def("update_surface", &Session::update_surface)
      .def("force", &Session::force, "tool"_a = 0)
      .def("contact_force", &Session::contact_force, "tool"_a = 0)
      .def("status", &Session::status, "tool"_a = 0)
      .def("error_bound", &Session::error_bound, "tool"_a = 0)
      .def_property_readonly("vertices", &Session::vertices)
      .def_property_readonly("normals", &Session::normals)
      .def_property_readonly("triangles", &Session::triangles);
}
