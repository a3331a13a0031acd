// SPDX-License-Identifier: MIT
#include "magnetism/kernel.h"

namespace ziggurat::magnetism {

const Kernel& best_kernel() {
  const Kernel* avx2 = avx2_kernel();
  return avx2 != nullptr ? *avx2 : baseline_kernel();
}

}  // namespace ziggurat::magnetism
