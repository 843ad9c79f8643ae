// Identifies this page among the open pages of this browser. Pages share the browser's storage. A
// page owns its unsent changes while it is open. After that, the next page takes them over.

const kName = 'roadbook_page';
const kReloadMs = 1000; // at most, until the page before the reload has released its name

const lockOf = (name: string): string => `${kName}_${name}`;

/** Holds a name until this page ends. Returns false if another page has the name. */
function claim(name: string, options: LockOptions): Promise<boolean> {
  return new Promise((done) => {
    navigator.locks
      .request(lockOf(name), options, (lock) => {
        done(lock !== null);
        return lock ? new Promise<void>(() => {}) : undefined;
      })
      .catch(() => done(false));
  });
}

/**
 * Returns a name that no other open page has. A reloaded page keeps its name. A copy of a page gets
 * a new one.
 */
export async function ownName(): Promise<string> {
  const before = sessionStorage.getItem(kName);
  if (before && (await claim(before, { signal: AbortSignal.timeout(kReloadMs) }))) return before;
  const name = crypto.randomUUID();
  await claim(name, { ifAvailable: true });
  sessionStorage.setItem(kName, name);
  return name;
}

/**
 * Returns whether the page of that name is closed. If so, this page alone takes over its changes.
 */
export function claimClosedPage(name: string): Promise<boolean> {
  return claim(name, { ifAvailable: true });
}
