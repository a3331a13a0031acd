#pragma once

#include <string>

namespace ziggurat::run {

/// Where the page's files are: installed, and built, beside the program. They are missing where the
/// page was not built.
std::string page_folder();

}  // namespace ziggurat::run
