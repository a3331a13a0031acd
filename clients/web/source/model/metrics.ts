// SPDX-License-Identifier: MIT
// Metrics: figures of a run that its controllers and directors measure. A running server sends them as /metrics with all
// values that hold; a recording has those that were set at a tick in its /inputs.

export const metricsTopic = "/metrics";

/** Fields of /inputs. */
export interface Metrics { metrics: { robot: string; name: string; value: number }[] }

/** Each as ROBOT/NAME, as in a run's summary. */
export function metricsIn(message: unknown): { path: string; value: number }[] {
  const { metrics, values } = (message ?? {}) as Partial<Metrics> & { values?: Record<string, number> };
  if (Array.isArray(metrics)) return metrics.map(({ robot, name, value }) => ({ path: `${robot}/${name}`, value }));
  return Object.entries(values ?? {}).map(([path, value]) => ({ path, value }));
}
