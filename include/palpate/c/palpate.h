/* The C interface of palpate: plain C99, for programs in C, C#, Python and other languages. Link libpalpate_c.
 *
 * Units are SI. Strings are UTF-8 and end with zero. Ids count from zero.
 *
 * Errors: functions that can fail return a palpate_error: PALPATE_OK or what went wrong. palpate_last_error then gives
 * the text, the ids and the values, for the calling thread. No C++ exception leaves the library.
 *
 * Structs: each begins with its size and the version of this interface, which PALPATE_INIT sets; it sets all else to
 * zero, and zero means the default. New versions of the library append fields, and they accept the shorter structs of
 * older programs. Structs of ticks never change: their size must be exact.
 *
 * Threads: see docs/c.md. Different handles are independent, except a tissue and its session. */
#ifndef PALPATE_C_PALPATE_H
#define PALPATE_C_PALPATE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(_WIN32) && defined(PALPATE_C_BUILD)
#define PALPATE_C_API __declspec(dllexport)
#elif defined(_WIN32)
#define PALPATE_C_API __declspec(dllimport)
#elif defined(__GNUC__)
#define PALPATE_C_API __attribute__((visibility("default")))
#else
#define PALPATE_C_API
#endif

/* The version of this interface. It changes only when programs must change. */
#define PALPATE_C_VERSION 1u

#define PALPATE_MOST_TOOLS 8      /* of a session */
#define PALPATE_MOST_ERROR_IDS 16 /* that an error lists */

/* Prepares a struct of this header: size, version, and the default of every option. */
#define PALPATE_INIT(pointer)                   \
  (memset((pointer), 0, sizeof *(pointer)),     \
   (pointer)->struct_size = sizeof *(pointer), \
   (pointer)->interface_version = PALPATE_C_VERSION)

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Errors -------------------------------------------------------------------------------------------------------*/

typedef int32_t palpate_error;

/* The kinds of SetupError (docs/errors.md), then those of this interface. */
enum {
  PALPATE_OK = 0,
  PALPATE_BAD_ARGUMENT = 1,
  PALPATE_BAD_POISSON_RATIO = 2,
  PALPATE_BAD_YOUNGS_MODULUS = 3,
  PALPATE_BAD_DENSITY = 4,
  PALPATE_NOT_POSITIVE_DEFINITE = 5,
  PALPATE_NON_FINITE = 6,
  PALPATE_EMPTY_MESH = 7,
  PALPATE_INDEX_OUT_OF_RANGE = 8,
  PALPATE_COUNT_TOO_LARGE = 9,
  PALPATE_DEGENERATE_ELEMENT = 10,
  PALPATE_INVERTED_ELEMENT = 11,
  PALPATE_POOR_QUALITY = 12,
  PALPATE_DUPLICATE_NODE = 13,
  PALPATE_DUPLICATE_ELEMENT = 14,
  PALPATE_ORPHAN_NODE = 15,
  PALPATE_DISCONNECTED = 16,
  PALPATE_NON_MANIFOLD = 17,
  PALPATE_UNCONSTRAINED = 18,
  PALPATE_SUSPICIOUS_UNITS = 19,
  PALPATE_UNKNOWN_GROUP = 20,
  PALPATE_EMPTY_GROUP = 21,
  PALPATE_CONFLICTING_CONDITIONS = 22,
  PALPATE_MISSING_MATERIAL = 23,
  PALPATE_TOO_LARGE = 24,
  PALPATE_ILL_CONDITIONED = 25,
  PALPATE_NOT_CONVERGED = 26,
  PALPATE_CANCELLED = 27,
  PALPATE_BAD_FILE = 28,
  PALPATE_UNSUPPORTED = 29,
  PALPATE_OUT_OF_MEMORY = 100,
  PALPATE_INVALID_ARGUMENT = 101, /* null, a struct of another size or version, a buffer that is too small */
  PALPATE_INTERNAL_ERROR = 102    /* an exception of the standard library, or of a callback */
};

/* What the ids of an error are. */
enum { PALPATE_IDS_OTHER = 0, PALPATE_IDS_NODES = 1, PALPATE_IDS_ELEMENTS = 2 };

/* The last error of a thread. */
typedef struct palpate_error_info {
  uint32_t struct_size, interface_version;
  palpate_error kind;
  int32_t ids_of;                      /* what the ids are: PALPATE_IDS_... */
  int64_t count;                       /* of all affected, listed or not */
  int64_t ids[PALPATE_MOST_ERROR_IDS]; /* of the mesh as given; the first id_count */
  int32_t id_count;
  int32_t reserved;
  double value;     /* measured */
  double threshold; /* the bound it broke */
  char text[1024];  /* one sentence with the measured value; cut off where it is longer */
  char hint[512];   /* what to change; may be empty */
} palpate_error_info;

/* The error that the last failed call of this thread returned; kind PALPATE_OK if none has failed. Calls that succeed do
 * not change it. */
PALPATE_C_API palpate_error palpate_last_error(palpate_error_info* info);
/* For example "inverted_element"; "unknown" for a number that is no error. Never null. */
PALPATE_C_API const char* palpate_error_name(palpate_error kind);
/* Name of bit 0 ... palpate_status_count() - 1 of a status, for example "Saturated"; null for another bit. */
PALPATE_C_API const char* palpate_status_name(int32_t bit);
PALPATE_C_API int32_t palpate_status_count(void);

/* Version of the interface that the library has, PALPATE_C_VERSION of its header. */
PALPATE_C_API uint32_t palpate_interface_version(void);
/* Version of palpate, for example "0.1.0". */
PALPATE_C_API const char* palpate_version(void);

/* ---- Policies -----------------------------------------------------------------------------------------------------*/

/* A composition is named "element/material/solver", for example "smoothed_tet4/linear/condensed". */
PALPATE_C_API size_t palpate_policy_count(void);
/* Name of policy number 0 ... palpate_policy_count() - 1; null for another number. */
PALPATE_C_API const char* palpate_policy_name(size_t number);

/* ---- Mesh ---------------------------------------------------------------------------------------------------------*/

/* Nodes, cells and groups. Needed until the tissue has been created. */
typedef struct palpate_mesh palpate_mesh;

/* Reads a file: Gmsh, TetGen, Medit, legacy VTK, Abaqus, VegaFEM (docs/input.md). `scale` is the unit of the file in metres; 0: 1. */
PALPATE_C_API palpate_error palpate_mesh_read(const char* path, double scale, palpate_mesh** mesh);
/* From arrays, which are copied: x y z per node [m]; nodes_per_cell (4, 8, 10 or 20) node ids per cell in the order of
 * docs/your-mesh.md; a region per cell, or null. */
PALPATE_C_API palpate_error palpate_mesh_from_arrays(const double* positions, size_t node_count, const int32_t* cells,
                                                     size_t cell_count, int32_t nodes_per_cell, const int32_t* regions,
                                                     palpate_mesh** mesh);
/* Adds nodes to the group of that name. PALPATE_INDEX_OUT_OF_RANGE for nodes that do not exist (ids: their ids). */
PALPATE_C_API palpate_error palpate_mesh_add_group(palpate_mesh* mesh, const char* name, const int32_t* nodes,
                                                   size_t count);
/* The same with all nodes in a box with corners low and high, x y z each [m]. PALPATE_EMPTY_GROUP when there is none. */
PALPATE_C_API palpate_error palpate_mesh_add_group_in_box(palpate_mesh* mesh, const char* name, const double* low,
                                                          const double* high);
/* Number of nodes, and the corners of the box around them, x y z each [m]. Pointers may be null. */
PALPATE_C_API palpate_error palpate_mesh_extent(const palpate_mesh* mesh, size_t* node_count, double* low,
                                                double* high);
/* Null is allowed, as in all functions that destroy. */
PALPATE_C_API void palpate_mesh_destroy(palpate_mesh* mesh);

/* ---- Scene --------------------------------------------------------------------------------------------------------*/

/* Supports, loads and touchable parts, by names of groups: those of the mesh, its regions, and "surface", its whole
 * boundary. Names are resolved when the tissue is created. */
typedef struct palpate_scene palpate_scene;

PALPATE_C_API palpate_error palpate_scene_create(palpate_scene** scene);
PALPATE_C_API palpate_error palpate_scene_fix(palpate_scene* scene, const char* group);
/* Prescribes displacements, x y z [m]; NaN leaves a component free. */
PALPATE_C_API palpate_error palpate_scene_prescribe(palpate_scene* scene, const char* group,
                                                    const double* displacement);
/* Force per area, x y z [Pa], on the faces of a group. */
PALPATE_C_API palpate_error palpate_scene_traction(palpate_scene* scene, const char* group, const double* traction);
/* Pressure [Pa]; positive pushes onto the surface. */
PALPATE_C_API palpate_error palpate_scene_pressure(palpate_scene* scene, const char* group, double pressure);
/* Total force, x y z [N], shared equally by the nodes of a group. */
PALPATE_C_API palpate_error palpate_scene_point_load(palpate_scene* scene, const char* group, const double* force);
/* Acceleration, x y z [m/s^2]. */
PALPATE_C_API palpate_error palpate_scene_gravity(palpate_scene* scene, const double* acceleration);
/* The part that tools may touch; `radius` of the smallest sphere [m], 0: not known. */
PALPATE_C_API palpate_error palpate_scene_touch(palpate_scene* scene, const char* group, double radius);
/* The part that is drawn; without a call, all of the boundary. */
PALPATE_C_API palpate_error palpate_scene_render(palpate_scene* scene, const char* group);
PALPATE_C_API void palpate_scene_destroy(palpate_scene* scene);

/* ---- Tissue -------------------------------------------------------------------------------------------------------*/

typedef struct palpate_tissue palpate_tissue;

/* Isotropic: of "linear" at small strain, of "neo_hookean" at small and large strain. */
typedef struct palpate_material {
  uint32_t struct_size, interface_version;
  const char* region;    /* null: everywhere */
  double youngs_modulus; /* [Pa] */
  double poisson_ratio;
  double density; /* [kg/m^3]; needed for gravity and motion */
} palpate_material;

/* Called during a set-up, from its thread, about every 10 ms; a result that is not zero cancels the set-up. `stage` is
 * valid during the call only; `fraction` of this stage, 0 ... 1. */
typedef int32_t (*palpate_progress)(void* user, const char* stage, double fraction);

/* A column is computed when a tool comes near: in the tick, or in a background thread, where it takes longer than about
 * 50 us. Then the first forces there are approximate (status DegradedModel), and not reproducible to the bit. */
enum { PALPATE_COLUMNS_AUTOMATIC = 0, PALPATE_COLUMNS_SYNCHRONOUS = 1, PALPATE_COLUMNS_ASYNCHRONOUS = 2 };

typedef struct palpate_setup {
  uint32_t struct_size, interface_version;
  const char* policy;                /* a name of palpate_policy_name */
  const palpate_material* materials; /* one, or one per region */
  uint64_t material_count;
  palpate_progress progress; /* or null */
  void* progress_user;
  uint64_t memory_limit;      /* [bytes]; more is refused; 0: none */
  int32_t threads;            /* of the set-up; 0: as many as the machine has */
  int32_t repair;             /* not 0: repairs what a mesh may have instead of refusing it (docs/your-mesh.md) */
  int32_t force_error_places; /* of the surface where the error of forces is measured; 0: not measured; static only */
  int32_t quasi_static;       /* quasi_newton; not 0: every step ends in equilibrium, without inertia */
  int32_t columns;            /* of the compliance, where not all are stored: PALPATE_COLUMNS_... */
  int32_t compliance_slots;   /* how many vertices have their columns then; 0: 256 */
  double step;                /* quasi_newton [s]; 0: the default */
  double mass_damping;        /* quasi_newton [1/s] */
  const char* cache_file;     /* stores the prepared system (docs/cache.md), or null; static only */
} palpate_setup;

/* Prepares a tissue. Mesh and scene may be destroyed afterwards. An unknown policy is refused with
 * PALPATE_INVALID_ARGUMENT and the list of policies in the hint. */
PALPATE_C_API palpate_error palpate_tissue_create(const palpate_mesh* mesh, const palpate_scene* scene,
                                                  const palpate_setup* setup, palpate_tissue** tissue);
/* Report of the set-up as JSON: sizes, memory [bytes], times [s], quality, accuracy, flags with a sentence each; of a
 * tissue that is cut also the cuts. Writes at most `capacity` bytes with the zero at the end; *length is the length
 * without it. Null with capacity 0 asks for the length. */
PALPATE_C_API palpate_error palpate_tissue_report(const palpate_tissue* tissue, char* text, size_t capacity,
                                                  size_t* length);
/* Displacement of every node of the mesh as given, x y z [m], in the axes of the mesh: of a static tissue under the loads
 * of the scene alone, of one that moves after its newest step. NaN for nodes that a repair has dropped. `capacity` in
 * numbers, at least 3 x the number of nodes. In the thread that draws. */
PALPATE_C_API palpate_error palpate_tissue_displacement(palpate_tissue* tissue, double* displacement, size_t capacity);
/* Pose of the frame of the mesh in the world: position x y z [m], unit quaternion w x y z. Not during a tick. */
PALPATE_C_API palpate_error palpate_tissue_set_pose(palpate_tissue* tissue, const double* position,
                                                    const double* quaternion);
/* Gravity in the world, x y z [m/s^2]. Of a static tissue not during a tick. */
PALPATE_C_API palpate_error palpate_tissue_set_gravity(palpate_tissue* tissue, const double* gravity);
/* Back to the state after creation. Not during a tick. */
PALPATE_C_API palpate_error palpate_tissue_reset(palpate_tissue* tissue);
/* Orders a cut along the sheet that an edge sweeps from its first position (ends a0, b0) to its second (a1, b1): x y z
 * of a0, b0, a1, b1 in the world [m]. PALPATE_UNSUPPORTED for a tissue that cannot be cut. The session applies it. */
PALPATE_C_API palpate_error palpate_tissue_cut(palpate_tissue* tissue, const double* sheet);
/* A session keeps its tissue until it is destroyed itself. */
PALPATE_C_API void palpate_tissue_destroy(palpate_tissue* tissue);

/* ---- Session ------------------------------------------------------------------------------------------------------*/

typedef struct palpate_session palpate_session;

enum { PALPATE_SPHERE = 0, PALPATE_CAPSULE = 1, PALPATE_BLADE = 2 };

typedef struct palpate_tool {
  uint32_t struct_size, interface_version;
  int32_t kind; /* PALPATE_SPHERE, PALPATE_CAPSULE, PALPATE_BLADE (for a tissue that can be cut) */
  int32_t reserved;
  double radius;      /* of a sphere or capsule [m]; 0: 4 mm */
  double half_length; /* of a capsule, from its middle to the centre of an end [m] */
  double axis[3];     /* of a capsule, in the tool's frame; zeros: z */
  double edge[3];     /* of a blade, from one end to the other, in the world [m]; zeros: 10 mm along y */
  double toughness;   /* of a blade [J/m^2]; 0: 100 */
  double cut_spacing; /* of a blade: its path between two cuts [m]; 0: 1 mm */
} palpate_tool;

/* Limits of the devices, and contact. A default is that of DeviceLimits, ServoOptions or ContactParameters. */
typedef struct palpate_session_options {
  uint32_t struct_size, interface_version;
  double rate;                 /* of ticks [1/s]; 0: 1000 */
  double peak_force;           /* [N]; 0: 3.3 */
  double continuous_force;     /* [N]; 0: 0.88 */
  double stiffness;            /* [N/m] that the device renders stably; 0: 500 */
  double peak_torque;          /* [N m]; 0: a device without torque */
  double rotational_stiffness; /* [N m/rad] that it renders stably */
  double friction;             /* Coulomb's coefficient */
  double stale_tissue_after;   /* [s] without a step of a tissue that moves until forces fade; 0: 0.5 */
  int32_t limit_energy;        /* not 0: an energy tank per tool (docs/stability.md) */
  int32_t corrected_force;     /* 1: subtracts the expected error where its bound is small (docs/force-error.md) */
  uint32_t grasp_buttons;      /* while one of these is pressed, a tool grasps the point it touched */
  int32_t manual_work;         /* not 0: no background thread; the caller calls palpate_session_work */
} palpate_session_options;

/* Which fields of a palpate_tool_state are given. */
enum {
  PALPATE_HAS_ORIENTATION = 1, /* else the identity */
  PALPATE_HAS_VELOCITY = 2,
  PALPATE_HAS_NOW = 4,
  PALPATE_UNREADABLE = 8 /* the device could not be read */
};

/* State of a tool as its device reports it, in the world. */
typedef struct palpate_tool_state {
  uint32_t struct_size, interface_version;
  double position[3];    /* [m] */
  double velocity[3];    /* [m/s] */
  double orientation[4]; /* unit quaternion w x y z */
  double time;           /* [s] at which it was measured, on a clock that does not run backwards */
  double now;            /* [s] the present time on this clock; without it only stamps that do not change become stale */
  uint32_t buttons;
  uint32_t given; /* PALPATE_HAS_..., PALPATE_UNREADABLE */
} palpate_tool_state;

/* What a tick returns for a tool. */
typedef struct palpate_tool_force {
  uint32_t struct_size, interface_version; /* set by the caller */
  double force[3];                         /* for the device: finite, limited, slew-limited [N] */
  double torque[3];                        /* about the tool's position [N m] */
  double contact_force[3];                 /* before the force gate [N] */
  double error_expected;                   /* of the contact force [N]; see docs/force-error.md */
  double error_bound;                      /* [N]; infinity: not measured */
  uint32_t status;                         /* bits, see palpate_status_name; 0: nothing to report */
  int32_t contacts;                        /* contact rows of all tools */
} palpate_tool_force;

/* A session of one or more tools on a tissue, which has one session at a time. `options` may be null. Allocates all that
 * a tick needs; for tissue that moves or is cut, starts the background thread. */
PALPATE_C_API palpate_error palpate_session_create(palpate_tissue* tissue, const palpate_tool* tools, size_t tool_count,
                                                   const palpate_session_options* options, palpate_session** session);
/* `tick_count` ticks: states and forces have one entry per tool for the first tick, then for the next. Allocates
 * nothing, takes no lock, never waits. A pose that is not finite is not an error: the status reports it. */
PALPATE_C_API palpate_error palpate_session_tick(palpate_session* session, const palpate_tool_state* states,
                                                 size_t tick_count, palpate_tool_force* forces);
/* Back to the state after creation, except the heat of the motors. In the thread that ticks. */
PALPATE_C_API palpate_error palpate_session_reset(palpate_session* session);
/* With manual_work: one step of a tissue that moves, or all cuts that wait; *worked is 0 when there was nothing to do.
 * `worked` may be null. Without manual_work PALPATE_INVALID_ARGUMENT; if the background thread has stopped because of an
 * error (status StalledTissue), that error. */
PALPATE_C_API palpate_error palpate_session_work(palpate_session* session, int32_t* worked);

/* The drawn surface. One thread draws; it never delays the thread that ticks. */
PALPATE_C_API palpate_error palpate_session_surface_size(const palpate_session* session, size_t* point_count,
                                                         size_t* triangle_count);
/* Three points per triangle. `capacity` in numbers, at least 3 x triangle_count. */
PALPATE_C_API palpate_error palpate_session_triangles(const palpate_session* session, int32_t* points, size_t capacity);
/* Positions and unit normals in the world after the newest tick, x y z per point. `capacity` in numbers, at least 3 x
 * point_count, for each of the two; normals may be null. Allocates only for a tissue that is cut. */
PALPATE_C_API palpate_error palpate_session_read_surface(palpate_session* session, float* positions, float* normals,
                                                         size_t capacity);
/* For a tissue that is cut: *changed is 1 when points and triangles have changed, and their numbers with them. */
PALPATE_C_API palpate_error palpate_session_update_surface(palpate_session* session, int32_t* changed);

/* The tools after a tick. */
typedef struct palpate_snapshot {
  uint32_t struct_size, interface_version;
  double time; /* stamp of the first tool's state [s] */
  int32_t tool_count;
  int32_t contact_count;                           /* that press, of all tools */
  double proxies[3 * PALPATE_MOST_TOOLS];          /* where each tool rests on the surface, to draw it there [m] */
  double contact_forces[3 * PALPATE_MOST_TOOLS];   /* [N] */
} palpate_snapshot;

/* Of the newest tick; in the thread that draws. */
PALPATE_C_API palpate_error palpate_session_snapshot(palpate_session* session, palpate_snapshot* snapshot);
/* Waits for the background thread to end. */
PALPATE_C_API void palpate_session_destroy(palpate_session* session);

#ifdef __cplusplus
}
#endif

#endif
