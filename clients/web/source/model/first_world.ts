// SPDX-License-Identifier: MIT
// Parts that a recording must have: a type of its messages, and a world that can be read.
import type { Container } from "../data/container";
import { makeDecoder, Unreadable, type Decoder } from "../data/decode";
import { checkWorld } from "./check";
import type { World } from "./messages";

/** Why a message can't be read, as the end of a sentence that begins with it. */
export function endOf(error: unknown): string { return error instanceof Unreadable ? error.message : "is damaged"; }

export function decoderIn(container: Container, id: number): Decoder | null {
  const channel = container.channels.get(id);
  const schema = channel && container.schemas.get(channel.schema);
  if (!channel || !schema || channel.encoding !== "protobuf" || schema.encoding !== "protobuf") return null;
  try {
    return makeDecoder(schema.data, schema.name);
  } catch {
    return null;
  }
}

/** The first world of the file that can be read. */
export async function findWorld(container: Container): Promise<World> {
  let fault = "";
  for (const chunk of container.chunks.slice(0, 20)) {
    for (const message of await container.read(chunk)) {
      if (container.channels.get(message.channel)?.topic !== "/world") continue;
      const decoder = decoderIn(container, message.channel);
      if (!decoder) throw new Error("the type of its topic /world is unknown or damaged");
      let world: World;
      try {
        world = decoder(message.data) as unknown as World;
      } catch (error) {
        fault ||= `/world at ${(Number(message.timeNs - container.chunks[0].startNs) * 1e-9).toFixed(2)} s ${endOf(error)}`;
        continue;
      }
      if (!(world.tickNs > 0)) throw new Error("its world has no tick");
      checkWorld(world);
      return world;
    }
  }
  if (fault) throw new Error(`its ${fault}`);
  throw new Error("has no topic /world: it is no recording of Ziggurat");
}
