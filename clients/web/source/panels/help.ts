// SPDX-License-Identifier: MIT
// Keys, mouse and touch.
import { make } from "./element";

const keys: [string, string][] = [
  ["space", "play or pause"], ["n", "one tick"], ["r", "back to the start"], ["[  ]", "slower, faster"],
  [",  .", "one frame back, ahead"], ["<  >", "fifty frames back, ahead"], ["Home  End", "the oldest frame; the newest (live)"],
  ["↑ ↓ ← →", "orbit; with shift: pan"], ["+  −", "zoom"], ["a", "look at all that moves"], ["f", "look at what is selected"],
  ["g", "follow what is selected"], ["o", "from the top"], ["t", "trail of what is selected"],
  ["v  m", "select, or move with the mouse"],
  ["u", "ruler: the length between two clicks"], ["i", "motion between ticks, or each tick as it is"], ["y", "colours of robots: as in the scene, by model, by controller"],
  ["z", "scale, axes and compass"], ["x", "rays and radio of all robots, also where they are many"], ["Delete", "remove what is selected"], ["/", "search"],
  ["1 … 9, 0", "switch a layer"], ["d p c b", "devices, plots, camera, controllers"], ["k", "log"], ["s", "bookmark this moment"], ["j", "save a picture"], ["w", "begin or end a film"], ["q", "copy a link to this moment"], ["l", "light or dark"], ["e", "open a recording"],
  ["Esc", "select nothing"], ["?", "this list"],
];

export function fillHelp(dialog: HTMLDialogElement): void {
  dialog.append(make("h2", {}, "Keys"), make("table.keys", {}, ...keys.map(([key, what]) =>
    make("tr", {}, make("td", {}, make("kbd", {}, key)), make("td", {}, what)))),
    make("h2", {}, "Mouse and touch"),
    make("p", {}, "Drag to orbit (one finger), right drag to pan (two fingers), wheel or pinch to zoom. Click to select, double "
      + "click to look at it. With the tool “move” (m), drag an object over the floor; with shift, up and down; shift + right click "
      + "takes the place for “Spawn”."),
    make("h2", {}, "Time"),
    make("p", {}, "The line at the bottom has all frames that this page has seen. Drag it to look back; the world runs on, and “play” "
      + "plays the past from there. Marks stand in lanes: bookmarks; resets and other acts; connections of controllers and missed deadlines; "
      + "collisions (in worlds with many links only while the layer “Contacts” is on); log lines, with warnings yellow and errors red. "
      + "A click on a mark shows its moment; the button beside the line switches lanes."),
    make("h2", {}, "Recordings"),
    make("p", {}, "Drop a file .mcap on the page, or press “Open”: it plays with the same time line, plots and camera views, without "
      + "a server. Nothing of it is run."),
    make("h2", {}, "Links"),
    make("p", {}, "The address shows this view: camera, layers, selection and plots, bookmarks, and the tick at which time stands. The "
      + "link that is copied (y) has no token: who opens it may look and not control. A picture (i) and a film (x) show what you see."),
    make("button.primary", { click: () => dialog.close() }, "Close"));
  dialog.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); });
}
