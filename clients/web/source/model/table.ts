// SPDX-License-Identifier: MIT
// Series as a table: a row for each frame, a column for each series.
import type { Series } from "./series";

/** A field of CSV. A text that a spreadsheet would compute as a formula gets an apostrophe before it. */
function field(text: string): string {
  const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

/** @param labels  of the columns */
export function csvOf(series: Series[], labels: string[]): string {
  const rows = new Map<number, { time: number; values: (number | null)[] }>();
  series.forEach(({ sequences, times, values }, column) => sequences.forEach((sequence, i) => {
    let row = rows.get(sequence);
    if (!row) rows.set(sequence, row = { time: times[i], values: Array<number | null>(series.length).fill(null) });
    row.values[column] = values[i];
  }));
  const lines = [...rows].sort(([a], [b]) => a - b).map(([, { time, values }]) =>
    [String(Number(time.toFixed(9))), ...values.map((value) => (value === null ? "" : String(value)))].join(","));
  return [["time [s]", ...labels].map(field).join(","), ...lines, ""].join("\n");
}
