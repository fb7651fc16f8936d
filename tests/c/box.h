/* A box of tetrahedra in plain arrays, for the tests of the C interface. */
#ifndef PALPATE_TESTS_C_BOX_H
#define PALPATE_TESTS_C_BOX_H

#include <stddef.h>
#include <stdint.h>

enum { BOX_NX = 6, BOX_NY = 5, BOX_NZ = 4 };
enum { BOX_NODES = (BOX_NX + 1) * (BOX_NY + 1) * (BOX_NZ + 1), BOX_CELLS = 6 * BOX_NX * BOX_NY * BOX_NZ };

typedef struct box {
  double positions[3 * BOX_NODES];
  int32_t cells[4 * BOX_CELLS];
  int32_t bottom[(BOX_NX + 1) * (BOX_NY + 1)], top[(BOX_NX + 1) * (BOX_NY + 1)];
  size_t side; /* number of nodes of bottom and of top */
} box;

static int32_t box_node(int i, int j, int k) { return (int32_t)((k * (BOX_NY + 1) + j) * (BOX_NX + 1) + i); }

/* 60 x 50 x 40 mm; x from -30 mm, y from -25 mm, z from 0. Six tetrahedra per cube, around its diagonal. */
static void make_box(box* b) {
  static const int order[6][2] = {{0, 1}, {1, 0}, {1, 2}, {2, 1}, {2, 0}, {0, 2}};
  int i, j, k, t;
  int32_t* cell = b->cells;
  b->side = 0;
  for (k = 0; k <= BOX_NZ; ++k)
    for (j = 0; j <= BOX_NY; ++j)
      for (i = 0; i <= BOX_NX; ++i) {
        double* x = b->positions + 3 * box_node(i, j, k);
        x[0] = 0.01 * i - 0.03;
        x[1] = 0.01 * j - 0.025;
        x[2] = 0.01 * k;
        if (k == 0) {
          b->top[b->side] = box_node(i, j, BOX_NZ);
          b->bottom[b->side++] = box_node(i, j, k);
        }
      }
  for (k = 0; k < BOX_NZ; ++k)
    for (j = 0; j < BOX_NY; ++j)
      for (i = 0; i < BOX_NX; ++i)
        for (t = 0; t < 6; ++t) {
          /* From the first corner along two axes, then the third: an even permutation has positive volume. */
          const int a = order[t][0], c = order[t][1], odd = (c - a + 3) % 3 != 1;
          int at[3], n;
          int32_t nodes[4];
          at[0] = i, at[1] = j, at[2] = k;
          nodes[0] = box_node(at[0], at[1], at[2]);
          ++at[a];
          nodes[1] = box_node(at[0], at[1], at[2]);
          ++at[c];
          nodes[2] = box_node(at[0], at[1], at[2]);
          nodes[3] = box_node(i + 1, j + 1, k + 1);
          for (n = 0; n < 4; ++n) cell[n] = nodes[n];
          if (odd) cell[1] = nodes[2], cell[2] = nodes[1];
          cell += 4;
        }
}

#endif
