// A program that wants a mesh and no more, and includes all of palpate for it.
#include <palpate/palpate.hpp>

#include <iostream>

int main() {
  const auto mesh = palpate::box_tet4({0.04, 0.04, 0.02}, {4, 4, 2});
  std::cout << mesh.positions.size() << " nodes, " << mesh.elements.size() << " elements\n";
}
