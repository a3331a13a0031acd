// SPDX-License-Identifier: MIT
#pragma once
// A sweep as an indexed Job of Kubernetes.

#include <cstddef>
#include <string>
#include <vector>

namespace ziggurat::sweep {

struct KubernetesOptions {
  std::string image;  ///< of containers that have `ziggurat`
  std::string claim;  ///< the PersistentVolumeClaim with the scene and the folder of results
  std::string mount;  ///< where it is in the containers, as on this machine: absolute path
};

/// The manifest: an object of batch/v1, which Kubernetes has since 1.21 with completionMode
/// Indexed.
/// @param tasks    how many: each is a completion, with its number in JOB_COMPLETION_INDEX
/// @param command  of a task: program and arguments
/// @param jobs     runs at a time of a task, each with a processor
std::string kubernetes_manifest(std::size_t tasks, const std::vector<std::string>& command,
                                unsigned jobs, const KubernetesOptions& options);

}  // namespace ziggurat::sweep
