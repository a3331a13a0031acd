#pragma once

namespace ziggurat::text {

/// Prepares the output of main(), which calls it first. It calls open_standard_streams(). A file
/// that grows beyond `ulimit -f` becomes an error of write() instead of SIGXFSZ.
void prepare_output();

/// Opens /dev/null for each of stdin, stdout and stderr that the parent has closed (`>&-`):
/// otherwise the first file or socket that is opened would get its number, and what is printed.
void open_standard_streams();

}  // namespace ziggurat::text
