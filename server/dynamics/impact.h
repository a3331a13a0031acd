#pragma once
// When contacts with restitution are met within a substep, and how they rebound.

#include "dynamics/problem.h"

namespace ziggurat::dynamics {

/// Lets contacts with restitution seek the speeds with which they rebound, and end where they do; to be called when all blocks are
/// there, before the problem is solved.
///
/// What carries a body still does in the impact; what nothing carries falls freely before and after it. What else bodies are pushed
/// by does not count.
void aim_rebounds(Problem& problem);

}  // namespace ziggurat::dynamics
