#pragma once

#include <string>

namespace ziggurat::run {

/// Folders of the page's files: installed, and built, beside the program. They are missing if the
/// page was not built.
std::string page_folder();

}  // namespace ziggurat::run
