#pragma once

namespace ziggurat::text {

/// What main() calls first: open_standard_streams(); and a file that grows beyond `ulimit -f` is an error of write(),
/// with its sentence, instead of SIGXFSZ.
void prepare_output();

/// Opens /dev/null for each of stdin, stdout and stderr that the parent has closed (`>&-`): otherwise the
/// first file or socket that is opened would get its number, and what is printed.
void open_standard_streams();

}  // namespace ziggurat::text
