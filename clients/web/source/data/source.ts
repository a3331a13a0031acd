// SPDX-License-Identifier: MIT
// Where the page's data come from: a running server (live.ts), a world made in the page (generated.ts), or a recording
// (../model/recorded.ts). The rest of the page knows this interface only.

/** A decoded message: fields by their names in camelCase; packed numbers are typed arrays. */
export type Value = Record<string, unknown>;

/** A message of a topic. It stays encoded until it is read. */
export interface Message {
  readonly topic: string;
  readonly timeNs: bigint; // simulated
  readonly bytes: number; // how much memory it holds
  read<T = Value>(): T;
}

export type Phase = "connecting" | "open" | "closed";

export interface Status {
  phase: Phase;
  text: string; // what a user should know: what is wrong and what to do
  mayControl: boolean; // pause, move, spawn …
  session: string; // differs for each start of a server
}

export interface Listener {
  status(status: Status): void;
  /** All topics that there are now, in alphabetical order. */
  topics(topics: string[]): void;
  message(message: Message): void;
  parameter(name: string, value: unknown): void;
  /** A log line of a recording. @param sequence  of its frame, @param seconds  simulated */
  logged?(line: { level: number; message: string; name: string }, sequence: number, seconds: number): void;
  /** A sentence for the user. */
  notice(level: "info" | "warning" | "error", text: string): void;
}

export interface Source {
  readonly name: string;
  /** False where a service can never be called, as in a recording. */
  readonly isLive: boolean;
  start(listener: Listener): void;
  /** Messages of these topics are wanted, and no others. */
  want(topics: ReadonlySet<string>): void;
  /** Calls a service; rejects with a sentence for the user. */
  call(service: string, request: Value): Promise<Value>;
  /** What came has been shown: the source may send more. */
  ready?(): void;
  setParameter(name: string, value: number | boolean): void;
  close(): void;
}
