#pragma once

#include "magnetism/kernel.h"

namespace ziggurat::magnetism {

/// Nothing where the processor has no AVX2.
const Kernel* avx2_kernel();

}  // namespace ziggurat::magnetism
