// SPDX-License-Identifier: MIT
// A worker of the page: decodes messages, so that what is drawn does not wait for it.
import { serve } from "./data/decoding";

serve(self as unknown as Parameters<typeof serve>[0]);
