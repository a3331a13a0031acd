// Opening a recording: dropped on the page, chosen from the disk, or contained in the page itself.
import { readable } from "../data/container";
import { Recorded } from "../model/recorded";
import type { App } from "./app";

let latest = 0; // of the files that were opened: a slow one does not replace a later one

/** Shows a recording, or says why it can't. */
export async function openRecording(app: App, file: Blob, name: string): Promise<void> {
  const number = ++latest;
  try {
    const recorded = await Recorded.open(readable(file), name);
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
    if (file) void openRecording(app, file, file.name);
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
    if (file) void openRecording(app, file, file.name);
  });
  return () => chooser.click();
}

/** The recording inside of the page that `ziggurat export --html` wrote; null: there is none. */
export function embedded(): { file: Blob; name: string } | null {
  const element = document.getElementById("recording");
  const text = element?.textContent?.trim() ?? "";
  if (!element || !/^[A-Za-z0-9+/]/.test(text)) return null; // the place is kept by another letter
  const parts: Uint8Array<ArrayBuffer>[] = [];
  const step = 1 << 20; // letters, a multiple of four
  for (let at = 0; at < text.length; at += step) {
    const letters = atob(text.slice(at, at + step));
    const bytes = new Uint8Array(letters.length);
    for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
    parts.push(bytes);
  }
  element.remove(); // its memory is needed elsewhere
  return { file: new Blob(parts), name: element.dataset.name || "recording" };
}
