// SPDX-License-Identifier: MIT
// Messages on their way through a worker that decodes them; they come back in the order in which they were given. Where
// there is no worker, as in a page in one file, they are decoded at once.
import { makeDecoder, type Decoder } from "./decode";
import type { Value } from "./source";

/** What is decoded: a part of a buffer that is given away and comes back. */
interface Task { schema: number; buffer: ArrayBuffer; offset: number; length: number }
type Done = { buffer: ArrayBuffer; value: Value } | { fault: string };
type Take = (bytes: Uint8Array, value: Value) => void;
type Fail = (fault: string) => void;

interface Port {
  postMessage(message: unknown, transfer?: Transferable[]): void;
  onmessage: ((event: MessageEvent) => void) | null;
}

const largeBytes = 1024; // smaller memory is sooner copied

/** Memory of a message's own long rows of packed numbers, which changes hands without being copied. */
export function buffersIn(value: Value): ArrayBuffer[] {
  return Object.values(value).filter((row) => row instanceof Float32Array || row instanceof Float64Array)
    .map(({ buffer }) => buffer as ArrayBuffer).filter(({ byteLength }) => byteLength >= largeBytes);
}

/** The worker's side. */
export function serve(port: Port): void {
  const decoders: Decoder[] = [];
  port.onmessage = ({ data }: MessageEvent<Task | { set: Uint8Array; name: string }>) => {
    if ("set" in data) {
      decoders.push(makeDecoder(data.set, data.name));
      return;
    }
    try {
      const value = decoders[data.schema](new Uint8Array(data.buffer, data.offset, data.length));
      port.postMessage({ buffer: data.buffer, value } satisfies Done, [data.buffer, ...buffersIn(value)]);
    } catch (error) {
      port.postMessage({ fault: (error as Error).message } satisfies Done);
    }
  };
}

export class Decoding {
  private waiting: { offset: number; length: number; take: Take; fail: Fail }[] = [];
  private schemas = new Map<Decoder, number>();

  /** @param worker  null: there is none */
  constructor(private readonly worker: Port | null) {
    if (worker) worker.onmessage = ({ data }: MessageEvent<Done>) => this.done(data);
  }

  /** A decoder's schema, before its first message. @param name  of the type */
  add(decoder: Decoder, set: Uint8Array, name: string): void {
    this.schemas.set(decoder, this.schemas.size);
    this.worker?.postMessage({ set, name });
  }

  /** Decodes a message, whose buffer is given away. */
  decode(decoder: Decoder, { buffer, byteOffset: offset, byteLength: length }: DataView, take: Take, fail: Fail): void {
    if (!this.worker) {
      const bytes = new Uint8Array(buffer as ArrayBuffer, offset, length);
      let value: Value;
      try {
        value = decoder(bytes);
      } catch (error) {
        return fail((error as Error).message);
      }
      return take(bytes, value);
    }
    this.waiting.push({ offset, length, take, fail });
    const task: Task = { schema: this.schemas.get(decoder)!, buffer: buffer as ArrayBuffer, offset, length };
    this.worker.postMessage(task, [task.buffer]);
  }

  get isBusy(): boolean { return this.waiting.length > 0; }

  /** What was given so far does not come any more. */
  forget(): void { for (const each of this.waiting) each.take = each.fail = () => undefined; }

  private done(done: Done): void {
    const { offset, length, take, fail } = this.waiting.shift()!;
    if ("fault" in done) fail(done.fault);
    else take(new Uint8Array(done.buffer, offset, length), done.value);
  }
}

/** The page's worker, if it has one: a page in one file has not. */
export function pageWorker(): Port | null {
  const name = document.querySelector<HTMLElement>("script[data-worker]")?.dataset.worker;
  if (!name || location.protocol === "file:" || typeof Worker === "undefined") return null;
  try {
    return new Worker(new URL(name, location.href));
  } catch {
    return null;
  }
}
