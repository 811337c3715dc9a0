// One reader for each format: the bytes of a file -> a triangle soup. Internal to read_mesh().
//
// Why not CGAL's polygon-soup readers (CGAL 5.5: CGAL/IO/OBJ.h, OFF.h, PLY.h, STL.h): they say only
// that reading failed, not where or why; OBJ refuses unknown keywords, joins no continued lines and
// lets an index one past the end through; OFF allocates what the header claims, and PLY what a list
// claims, before anything is read; a binary STL of fewer than 80 bytes counts as read; text PLY of
// type float loses decimals; and they parse through iostreams, 4 to 11 times slower (1.3 million
// triangles). What these readers do instead is in tests/unit/mesh_file_test.cpp and
// mesh_file_error_test.cpp.
//
// All readers: errors are InputError without a path (read_mesh adds it), nothing is allocated on
// the word of a header alone, degenerate and duplicate faces stay. Colours of vertices are read as
// vertex_colours.h says; one that makes no sense is no error. O(size of the file).
#pragma once

#include <string_view>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut::mesh_io {

// Wavefront OBJ: `v` and `f`; everything else is skipped, and so are
// faces of one or two corners (counted). After x y z, three or four numbers are a colour (and its
// opacity, which is left out); anything else there is ignored.
TriangleSoup read_obj(std::string_view bytes);
// Geomview OFF in text: OFF, COFF, NOFF, STOFF and their combinations; of the columns beyond x y z
// the colour is read where the keyword has a C; those beyond the corners of a face are ignored. The
// counts may stand on the line of the keyword, even without a blank (as in ModelNet). Binary OFF
// and the 4- and n-dimensional variants are refused.
TriangleSoup read_off(std::string_view bytes);
// Stanford PLY, text and binary of both byte orders, any further elements and properties.
// Colours: red green blue, or diffuse_red and so on.
TriangleSoup read_ply(std::string_view bytes);
// STL, text (any number of solids) and binary, told apart by the content. Points of equal
// coordinates are merged.
TriangleSoup read_stl(std::string_view bytes);

}  // namespace cellocut::mesh_io
