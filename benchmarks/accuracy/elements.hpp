// The list of elements that are compared.
#pragma once

#include "meshes.hpp"
#include "statics.hpp"

#include <string>
#include <string_view>
#include <tuple>

namespace accuracy {

template <Element... E>
struct ElementList {};

/// To compare another element, add its name here.
using Elements = ElementList<Tet4, Smoothed<Tet4>, Tet10, Hex8, MeanDilatation<Hex8>, Hex20>;

/// Calls visit(std::type_identity<E>) for every element of the list.
template <Element... E, class Visit>
void each_element(ElementList<E...>, Visit visit) {
  (visit(std::type_identity<E>{}), ...);
}
template <class Visit>
void each_element(Visit visit) {
  each_element(Elements{}, visit);
}

/// Solvers of all elements, instantiated in elements.cpp only.
template <class List>
struct Solvers;
template <Element... E>
struct Solvers<ElementList<E...>> {
  std::tuple<Solved (*)(const Body<E>&, const Scene&, const VectorX&)...> of{&solve_static<E>...};
};
const Solvers<Elements>& solvers();

template <Element E>
Solved solve(const Body<E>& body, const Scene& scene, const VectorX& more_load = {}) {
  return std::get<Solved (*)(const Body<E>&, const Scene&, const VectorX&)>(solvers().of)(body, scene, more_load);
}

/// The name of an element as written in a program, without namespaces.
template <Element E>
std::string element_name() {
#ifdef _MSC_VER
  std::string_view signature = __FUNCSIG__;
  const std::size_t start = signature.find("element_name<") + 13, end = signature.rfind(">(");
#else
  std::string_view signature = __PRETTY_FUNCTION__;
  const std::size_t start = signature.find("E = ") + 4, end = signature.find_first_of(";]", start);
#endif
  std::string name;
  for (const char c : signature.substr(start, end - start)) {
    if (c != ':') {
      if (c != ' ') name += c;  // "> >"
      continue;
    }
    while (!name.empty() && name.back() != '<') name.pop_back();
  }
  return name;
}

/// Number of cells along an edge of a mesh, given that for first-order elements. Second-order elements use half as many
/// cells, which gives about the same number of nodes.
template <Element E>
int cells(int for_linear) {
  return std::max(1, for_linear / E::order);
}

}  // namespace accuracy
