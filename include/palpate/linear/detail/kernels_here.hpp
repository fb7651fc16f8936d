// The dense kernels of the solvers, compiled with the flags of the including source.
#pragma once

#include <palpate/linear/detail/float_columns.hpp>
#include <palpate/linear/detail/front_block_substitution.hpp>
#include <palpate/linear/detail/front_kernels.hpp>
#include <palpate/linear/detail/kernel_types.hpp>
#include <palpate/linear/detail/product_kernels.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

template <int Packets>
inline void forward_block(const double* l, std::int64_t height, std::int64_t columns, double* x) noexcept {
  FrontBlock<Packets>::forward(l, {height, columns}, x);
}
template <int Packets>
inline void backward_block(const double* l, std::int64_t height, std::int64_t columns, double* x) noexcept {
  FrontBlock<Packets>::backward(l, {height, columns}, x);
}

inline constexpr any_flags::Kernels kernels_here{factor_front,
                                                 add_product_packed,
                                                 packet_size,
                                                 {forward_block<1>, forward_block<2>, forward_block<3>},
                                                 {backward_block<1>, backward_block<2>, backward_block<3>},
                                                 add_float_columns};

}}}  // namespace palpate::detail
