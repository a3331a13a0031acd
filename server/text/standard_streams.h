#pragma once

namespace ziggurat::text {

/// Opens /dev/null for each of stdin, stdout and stderr that the parent has closed (`>&-`): otherwise the
/// first file or socket that is opened would get its number, and what is printed. Call it first in main().
void open_standard_streams();

}  // namespace ziggurat::text
