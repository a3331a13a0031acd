// SPDX-License-Identifier: MIT
#include "sweep/kubernetes.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "text/numbers.h"
#include "text/printable.h"

namespace ziggurat::sweep {

// Texts are written as JSON has them, which YAML reads.
std::string kubernetes_manifest(std::size_t tasks, const std::vector<std::string>& command,
                                unsigned jobs, const KubernetesOptions& options) {
  for (const std::string& word : command) {
    if (!text::is_utf8(word))
      throw text::UsageError(
          fmt::format("'{}' is not UTF-8, as a manifest must be; rename it", word));
  }
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  return fmt::format(
      R"(apiVersion: batch/v1
kind: Job
metadata:
  generateName: ziggurat-sweep-
spec:
  completionMode: Indexed
  completions: {tasks}
  parallelism: {tasks}
  # A pod that is killed is started again, and goes on with the runs that it has not yet written down.
  backoffLimit: {retries}
  template:
    spec:
      restartPolicy: OnFailure
      containers:
        - name: sweep
          image: {image}
          command: {command}
          resources:
            requests:
              cpu: "{jobs}"
          volumeMounts:
            - name: data
              mountPath: {mount}
      volumes:
        - name: data
          persistentVolumeClaim:
            claimName: {claim}
)",
      fmt::arg("tasks", tasks), fmt::arg("retries", 6 * tasks),
      fmt::arg("image", quoted(options.image)), fmt::arg("command", nlohmann::json(command).dump()),
      fmt::arg("jobs", jobs), fmt::arg("mount", quoted(options.mount)),
      fmt::arg("claim", quoted(options.claim)));
}

}  // namespace ziggurat::sweep
