// Reads the files of TetGen: x.node with x.ele and, if it exists, x.face.
#pragma once

#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::tetgen {

/// The texts of the files of one mesh; `name` is their common name without extensions.
struct Texts {
  std::string name;
  std::string_view node, ele, face;  ///< face may be empty
};

/// Reads the files. Ids count from 0 or 1, depending on the first node. Tags are boundary markers and region
/// attributes: groups "point 1", "surface 7", "volume 3". Errors: bad_file, index_out_of_range, count_too_large,
/// non_finite, unsupported, with file and line. Linear in the size of the texts.
FileMesh parse(const Texts& texts);

/// Reads the files of the mesh to which x.node, x.ele or x.face belongs.
FileMesh read(const std::string& path);

}}}  // namespace palpate::PALPATE_ABI::io::tetgen

#if PALPATE_HEADER_ONLY
#include <palpate/io/tetgen.ipp>
#endif
