/* The press that all languages repeat: a sphere into the organ of the examples, 1024 ticks. Prints a hash of all forces,
 * the last force as hexadecimal digits, and the time of a tick. Positions are multiples of 2^-22 m, so that every
 * language computes them exactly.
 *
 *   press organ.msh */
#include <palpate/c/palpate.h>

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static void require(palpate_error error) {
  palpate_error_info info;
  if (error == PALPATE_OK) return;
  PALPATE_INIT(&info);
  palpate_last_error(&info);
  fprintf(stderr, "%s: %s. %s\n", palpate_error_name(error), info.text, info.hint);
  exit(1);
}

static void place(palpate_tool_state* state, int i, double time) {
  state->position[0] = -127.0 / 4096;
  state->position[1] = (-147.0 * 1024 + 16.0 * i) / (4096.0 * 1024);
  state->position[2] = (246.0 * 1024 - 90.0 * i) / (4096.0 * 1024);
  state->time = state->now = time;
  state->given = PALPATE_HAS_NOW;
}

/* FNV-1a over the bytes of three doubles. */
static uint64_t add_to_hash(uint64_t hash, const double* v) {
  unsigned char bytes[24];
  size_t k;
  memcpy(bytes, v, sizeof bytes);
  for (k = 0; k < sizeof bytes; ++k) hash = (hash ^ bytes[k]) * 1099511628211u;
  return hash;
}

/* Microseconds per tick at a position of the path. */
static double time_ticks(palpate_session* session, palpate_tool_state* state, int i, int* tick) {
  enum { ticks = 100000 };
  palpate_tool_force force;
  clock_t start;
  int k;
  PALPATE_INIT(&force);
  start = clock();
  for (k = 0; k < ticks; ++k) {
    place(state, i, 1e-3 * (*tick)++);
    require(palpate_session_tick(session, state, 1, &force));
  }
  return 1e6 * (double)(clock() - start) / CLOCKS_PER_SEC / ticks;
}

int main(int count, char** arguments) {
  palpate_mesh* mesh;
  palpate_scene* scene;
  palpate_tissue* tissue;
  palpate_session* session;
  palpate_material material;
  palpate_setup setup;
  palpate_tool tool;
  palpate_tool_state state;
  palpate_tool_force force;
  uint64_t hash = 14695981039346656037u, bits;
  double free_us, pressed_us;
  int tick;
  if (count < 2) return 2;
  require(palpate_mesh_read(arguments[1], 1.0, &mesh));
  require(palpate_scene_create(&scene));
  require(palpate_scene_fix(scene, "ligament"));
  require(palpate_scene_touch(scene, "front", 0.0));
  PALPATE_INIT(&material);
  material.youngs_modulus = 5e3;
  material.poisson_ratio = 0.45;
  material.density = 1060.0;
  PALPATE_INIT(&setup);
  setup.policy = "smoothed_tet4/linear/condensed";
  setup.materials = &material;
  setup.material_count = 1;
  require(palpate_tissue_create(mesh, scene, &setup, &tissue));
  PALPATE_INIT(&tool);
  tool.radius = 4e-3;
  require(palpate_session_create(tissue, &tool, 1, NULL, &session));

  PALPATE_INIT(&state);
  PALPATE_INIT(&force);
  for (tick = 0; tick < 1024; ++tick) {
    place(&state, tick, 1e-3 * tick);
    require(palpate_session_tick(session, &state, 1, &force));
    hash = add_to_hash(add_to_hash(hash, force.force), force.contact_force);
  }
  pressed_us = time_ticks(session, &state, 1024, &tick);
  free_us = time_ticks(session, &state, 0, &tick);
  printf("hash %016llx\nforce", (unsigned long long)hash);
  for (tick = 0; tick < 3; ++tick) {
    memcpy(&bits, &force.contact_force[tick], sizeof bits);
    printf(" %016llx", (unsigned long long)bits);
  }
  printf("\nfree_us %.3f\npressed_us %.3f\n", free_us, pressed_us);

  palpate_session_destroy(session);
  palpate_tissue_destroy(tissue);
  palpate_scene_destroy(scene);
  palpate_mesh_destroy(mesh);
  return 0;
}
