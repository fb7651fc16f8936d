// A program that uses only a mesh, but includes all of palpate.
#include <palpate/palpate.hpp>

#include <iostream>

int main() {
  const auto mesh = palpate::box_tet4({0.04, 0.04, 0.02}, {4, 4, 2});
  std::cout << mesh.positions.size() << " nodes, " << mesh.elements.size() << " elements\n";
}
