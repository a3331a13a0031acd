// SPDX-License-Identifier: MIT
// A running server, over the Foxglove WebSocket protocol. It connects again by itself.
import { FoxgloveClient, type Channel, type Service } from "@foxglove/ws-protocol";
import { makeDecoder, type Decoder } from "./decode";
import { Decoding, pageWorker } from "./decoding";
import { Held } from "./held";
import type { Listener, Source, Status, Value } from "./source";

const firstDelay = 250; // [ms] before the first new attempt; doubles up to
const longestDelay = 2000;
const leastPause = 25; // [ms] between two signs that the page is ready: who may only look sends at most fifty a second
const longestPause = 200; // [ms] until the next one, drawn or not: what waits longer at the server is lost

/** Why there is no connection, and what to do, for users. */
function explain(url: URL, hadWorld: boolean): string {
  if (hadWorld) {
    return `The server at ${url.host} closed the connection: the run was ended, or it crashed. What this page has seen can still be `
        + "looked at. It connects again by itself when the server is back …";
  }
  return `No connection to ${url.host}. Either no run is there (start one with: ziggurat run SCENE --view), `
      + "or it refuses this page: then the address has a wrong token; use the address that it printed. "
      + "Trying again …";
}

interface Pending {
  resolve: (value: Value) => void;
  reject: (error: Error) => void;
}

export class LiveSource implements Source {
  readonly isLive = true;
  readonly name: string;
  private listener!: Listener;
  private client: FoxgloveClient | null = null;
  private channels = new Map<number, Channel>();
  private decoders = new Map<string, Decoder>(); // by schema
  private services = new Map<string, Service>();
  private wanted: ReadonlySet<string> = new Set();
  private subscriptions = new Map<string, { id: number; channel: number }>();
  private bySubscription = new Map<number, { topic: string; decoder: Decoder }>();
  private pending = new Map<number, Pending>();
  private unread = new Set<string>(); // topics of which a message could not be read
  private nextCall = 1;
  private delay = firstDelay;
  private timer = 0;
  private socket: WebSocket | null = null; // of a server that waits until the page is ready
  private hasNews = false; // messages came since the page was ready
  private readyAt = -Infinity; // [ms]
  private readonly readyTimer: ReturnType<typeof setInterval>;
  private readonly decoding = new Decoding(pageWorker());
  private isClosed = false;
  private wasOpen = false;
  private status: Status = { phase: "connecting", text: "", mayControl: false, session: "" };

  /** @param url  of the WebSocket, with its token */
  constructor(private readonly url: URL) {
    this.name = url.host;
    this.readyTimer = setInterval(() => { if (performance.now() - this.readyAt >= longestPause) this.ready(); }, longestPause);
  }

  start(listener: Listener): void {
    this.listener = listener;
    this.connect();
  }

  close(): void {
    this.isClosed = true;
    clearTimeout(this.timer);
    clearInterval(this.readyTimer);
    this.client?.close();
  }

  want(topics: ReadonlySet<string>): void {
    this.wanted = topics;
    this.subscribe();
  }

  call(name: string, request: Value): Promise<Value> {
    const service = this.services.get(name);
    if (!this.client || this.status.phase !== "open") return Promise.reject(new Error("not connected"));
    if (!service) {
      return Promise.reject(new Error("this page may only look: open it with the address that the server "
        + "printed, which has the token"));
    }
    const callId = this.nextCall++;
    const data = new TextEncoder().encode(JSON.stringify(request));
    this.client.sendServiceCallRequest(
      { serviceId: service.id, callId, encoding: "json", data: new DataView(data.buffer) });
    return new Promise((resolve, reject) => this.pending.set(callId, { resolve, reject }));
  }

  ready(): void {
    const now = performance.now();
    if (!this.hasNews || this.decoding.isBusy || !this.socket || now - this.readyAt < leastPause) return;
    this.hasNews = false;
    this.readyAt = now;
    this.socket.send(JSON.stringify({ op: "ready" }));
  }

  setParameter(name: string, value: number | boolean): void {
    this.client?.setParameters([{ name, value }]);
  }

  private connect(): void {
    const socket = new WebSocket(this.url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
    const client = new FoxgloveClient({ ws: socket });
    client.on("serverInfo", (info) => {
      this.wasOpen = true;
      this.client = client;
      this.socket = info.metadata?.["takes_ready"] === "true" ? socket : null;
      this.delay = firstDelay;
      this.hasNews = true; // from the first tick on they come as the page takes them
      this.ready();
      client.subscribeParameterUpdates(["real_time_factor", "frames_per_second", "phase"]);
      client.getParameters(["real_time_factor", "frames_per_second", "phase", "replay"]);
      this.tell({ phase: "open", text: "", mayControl: info.metadata?.["may_steer"] === "true",
                  session: info.sessionId ?? "" });
    });
    client.on("error", () => undefined); // "close" follows
    client.on("close", () => {
      this.forget();
      if (this.isClosed) return;
      this.tell({ phase: "closed", text: explain(this.url, this.wasOpen), mayControl: false, session: "" });
      this.timer = setTimeout(() => this.connect(), this.delay) as unknown as number;
      this.delay = Math.min(2 * this.delay, longestDelay);
    });
    this.listen(client);
  }

  private listen(client: FoxgloveClient): void {
    client.on("advertise", (channels) => {
      for (const channel of channels) this.channels.set(channel.id, channel);
      this.subscribe();
      this.tellTopics();
    });
    client.on("unadvertise", (ids) => {
      for (const id of ids) {
        const topic = this.channels.get(id)?.topic;
        this.channels.delete(id);
        const held = topic === undefined ? undefined : this.subscriptions.get(topic);
        if (topic !== undefined && held?.channel === id) this.unsubscribe(topic);
      }
      this.subscribe();
      this.tellTopics();
    });
    client.on("time", () => { this.hasNews = true; }); // also of a tick of which nothing else is wanted
    client.on("message", ({ subscriptionId, timestamp, data }) => {
      this.hasNews = true;
      const held = this.bySubscription.get(subscriptionId);
      if (!held) return;
      const { topic, decoder } = held;
      this.decoding.decode(decoder, data as DataView, (bytes, value) => {
        this.listener.message(new Held(topic, timestamp, bytes, decoder, value));
      }, (fault) => this.leaveOut(topic, timestamp, fault));
    });
    client.on("advertiseServices", (services) => {
      for (const service of services) this.services.set(service.name, service);
    });
    client.on("serviceCallResponse", ({ callId, data }) => {
      const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
      this.take(callId)?.resolve(JSON.parse(new TextDecoder().decode(bytes)) as Value);
    });
    client.on("serviceCallFailure", ({ callId, message }) => this.take(callId)?.reject(new Error(message)));
    client.on("parameterValues", ({ parameters }) => {
      for (const { name, value } of parameters) this.listener.parameter(name, value);
    });
    client.on("status", ({ level, message }) => {
      this.listener.notice(level === 2 ? "error" : level === 1 ? "warning" : "info", message);
    });
  }

  /** A message can't be read, which is told once for each topic. */
  private leaveOut(topic: string, timeNs: bigint, fault: string): void {
    if (!this.unread.has(topic)) {
      this.listener.notice("warning", `${topic} at ${(Number(timeNs) * 1e-9).toFixed(2)} s ${fault}. It is left out.`);
    }
    this.unread.add(topic);
  }

  private subscribe(): void {
    if (!this.client) return;
    for (const topic of this.subscriptions.keys()) {
      if (!this.wanted.has(topic)) this.unsubscribe(topic);
    }
    for (const channel of this.channels.values()) {
      if (!this.wanted.has(channel.topic) || this.subscriptions.has(channel.topic)) continue;
      const decoder = this.decoderOf(channel);
      if (!decoder) continue;
      const id = this.client.subscribe(channel.id);
      this.subscriptions.set(channel.topic, { id, channel: channel.id });
      this.bySubscription.set(id, { topic: channel.topic, decoder });
    }
  }

  private unsubscribe(topic: string): void {
    const held = this.subscriptions.get(topic);
    if (!held) return;
    if (this.channels.has(held.channel)) this.client?.unsubscribe(held.id);
    this.subscriptions.delete(topic);
    this.bySubscription.delete(held.id);
  }

  private decoderOf(channel: Channel): Decoder | undefined {
    const key = `${channel.schemaName}\n${channel.schema}`;
    let decoder = this.decoders.get(key);
    if (decoder) return decoder;
    try {
      if (channel.encoding !== "protobuf") throw new Error(`encoding ${channel.encoding} is unknown`);
      const schema = Uint8Array.from(atob(channel.schema), (letter) => letter.charCodeAt(0));
      decoder = makeDecoder(schema, channel.schemaName);
      this.decoding.add(decoder, schema, channel.schemaName);
    } catch (error) {
      this.listener.notice("warning", `${channel.topic} can't be read: ${(error as Error).message}`);
      return undefined;
    }
    this.decoders.set(key, decoder);
    return decoder;
  }

  private take(callId: number): Pending | undefined {
    const pending = this.pending.get(callId);
    this.pending.delete(callId);
    return pending;
  }

  private forget(): void {
    this.client = this.socket = null;
    this.hasNews = false;
    this.decoding.forget();
    this.channels.clear();
    this.services.clear();
    this.subscriptions.clear();
    this.bySubscription.clear();
    for (const { reject } of this.pending.values()) reject(new Error("the connection was closed"));
    this.pending.clear();
  }

  private tell(status: Status): void {
    this.status = status;
    this.listener.status(status);
  }

  private tellTopics(): void {
    this.listener.topics([...this.channels.values()].map((channel) => channel.topic).sort());
  }
}
