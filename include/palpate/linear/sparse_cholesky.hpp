#pragma once
#include <palpate/linear/multifrontal_cholesky.hpp>
namespace palpate::inline PALPATE_ABI {
using SparseCholesky = MultifrontalCholesky;
}
