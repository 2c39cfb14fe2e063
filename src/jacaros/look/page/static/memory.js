// Some browsers give pages that were opened as files no storage, or refuse it: then nothing is remembered.

/** Remember a choice of the user, for this page and later ones. */
export function remember(name, value) {
  try { localStorage.setItem(`jacaros ${name}`, value); } catch { /* see above */ }
}

/** What was remembered, null for nothing. */
export function recall(name) {
  try { return localStorage.getItem(`jacaros ${name}`); } catch { return null; }
}
