#pragma once

#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// Refuses a file whose schema has more than roadbook and GDAL write: a view, a virtual table other
/// than an R-tree, or a trigger other than those of GeoPackage. Such a part would run inside of any
/// query or change, without end if it is made so. Throws BadInput that names the part.
void refuse_foreign_parts(const SqlDatabase& database);

}  // namespace roadbook
