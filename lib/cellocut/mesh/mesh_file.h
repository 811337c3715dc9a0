// Triangle meshes in files. Reading keeps everything (duplicate, degenerate, non-manifold faces).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cellocut/base/coordinates.h"
#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/mesh/vertex_attribute.h"

namespace cellocut {

// ply and stl: binary when written.
enum class MeshFormat { obj, off, ply, ply_ascii, stl, stl_ascii };

// From the file name's ending (.obj .off .ply .stl, any case); nothing where it is none of them.
std::optional<MeshFormat> format_of_path(std::string_view path);
// From a name as `--format` takes it: obj, off, ply, ply-ascii, stl, stl-ascii.
// Errors: UsageError that lists the names.
MeshFormat format_of_name(std::string_view name);

// Reads a mesh; `path` "-" is standard input, which needs `format`. For reading, ply and ply_ascii
// are the same, and so are stl and stl_ascii: the file says which it is. Polygons are triangulated
// (a fan where convex, a constrained triangulation of the projected polygon otherwise). STL corners
// with equal coordinates become one point. OBJ faces of one or two corners (loose edges, as some
// exporters write them) are counted in skipped_polygons and left out.
//
// Colours of vertices are read from PLY (red green blue, or diffuse_red and so on), OBJ (r g b
// after x y z) and OFF (COFF). Floating-point components are 0 to 1, or 0 to 255 where the file has
// any above 1. Vertices whose colour is missing or no number are white where others have one. STL
// has none: its points are merged.
//
// Errors: UsageError where the format cannot be told; InputError with the path and what is wrong:
// not there, a directory, empty, truncated, malformed (with the line where there are lines), a
// coordinate that is not finite, an index out of range, no faces.
TriangleSoup read_mesh(const std::string& path, std::optional<MeshFormat> format = {});

using ByteSink = std::function<void(std::string_view)>;

// Gives the bytes of a mesh file to the sink, in order and piece by piece, so that the file is
// never in memory as a whole. One call at a time, not all from one thread. Colours are written to
// PLY (uchar red green blue) and OBJ (r g b after x y z, 0 to 1), and read back as they are; OFF
// and STL leave them out. `attributes` become further vertex properties of PLY, uchar, int or
// double. Errors: InputError where colours or attributes are not one per point, or a name is no
// name of a property or is taken; UsageError for attributes in a format that is not PLY. OBJ, OFF,
// ASCII STL and ASCII PLY hold shortest decimals that read back as the same doubles; binary PLY
// holds doubles; binary STL holds floats (rounded to nearest).
void stream_mesh(const TriangleSoup& mesh, MeshFormat format,
                 std::span<const VertexAttribute> attributes, const ByteSink& sink);

// The same as one string.
std::string encode_mesh(const TriangleSoup& mesh, MeshFormat format,
                        std::span<const VertexAttribute> attributes = {});

// Writes through AtomicFile. `path` "-" is standard output. Errors: as stream_mesh(); OutputError.
void write_mesh(const TriangleSoup& mesh, const std::string& path, MeshFormat format,
                std::span<const VertexAttribute> attributes = {});

// Binary STL keeps floats, all other formats doubles.
Coordinates coordinates_of(MeshFormat format);

// The mesh that a reader of such a file will see: for binary STL coordinates rounded to float; for
// both kinds of STL, points of equal coordinates merged; for STL and OFF without colours; otherwise
// the mesh itself. Corner k of triangle f stays corner k of triangle f.
TriangleSoup as_read_back(const TriangleSoup& mesh, MeshFormat format);

}  // namespace cellocut
