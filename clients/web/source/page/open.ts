// SPDX-License-Identifier: MIT
// Opening a recording: dropped on the page, chosen from the disk, or contained in the page itself.
import type { IReadable } from "@mcap/core";
import { readable } from "../data/container";
import { Recorded } from "../model/recorded";
import type { App } from "./app";

let latest = 0; // of the files that were opened: a slow one does not replace a later one

/** Shows a recording, or says why it can't. */
export async function openRecording(app: App, file: IReadable, name: string): Promise<void> {
  const number = ++latest;
  try {
    const recorded = await Recorded.open(file, name);
    if (number === latest) app.open(recorded);
  } catch (error) {
    app.notice("error", (error as Error).message);
  }
}

/** Opens what is dropped on the page; returns what asks for a file of the disk. */
export function listenToFiles(app: App): () => void {
  const chooser = document.createElement("input");
  chooser.type = "file";
  chooser.id = "recording-file";
  chooser.accept = ".mcap";
  chooser.hidden = true;
  chooser.addEventListener("change", () => {
    const file = chooser.files?.[0];
    if (file) void openRecording(app, readable(file), file.name);
    chooser.value = "";
  });
  document.body.append(chooser);
  window.addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  window.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) document.body.classList.remove("dropping");
  });
  window.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    const file = event.dataTransfer?.files[0];
    if (file) void openRecording(app, readable(file), file.name);
  });
  return () => chooser.click();
}
