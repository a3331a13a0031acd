// SPDX-License-Identifier: MIT
/** A part of the page. */
export interface Panel {
  readonly element: HTMLElement;
  /** Shows what is true now; called some ten times a second. */
  update(): void;
}
