// Which of the pages that are open in this browser this one is. Pages share the browser's storage:
// what one has not sent yet is its own for as long as it is open, and the next page's after that.

const kName = 'roadbook_page';
const kReloadMs = 1000; // at most, until the page as it was before has let go of its name

const lockOf = (name: string): string => `${kName}_${name}`;

/** Holds a name until this page ends; false where another page has it. */
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

/** A name that no other open page has; a page that is loaded again keeps it, a copy of one does not. */
export async function ownName(): Promise<string> {
  const before = sessionStorage.getItem(kName);
  if (before && (await claim(before, { signal: AbortSignal.timeout(kReloadMs) }))) return before;
  const name = crypto.randomUUID();
  await claim(name, { ifAvailable: true });
  sessionStorage.setItem(kName, name);
  return name;
}

/** Whether a page of that name is open no longer; nobody else takes over what it has left. */
export function inherits(name: string): Promise<boolean> {
  return claim(name, { ifAvailable: true });
}
