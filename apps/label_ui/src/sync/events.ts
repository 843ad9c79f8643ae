// The events of the server. All pages of this browser share one event stream. A browser opens at
// most six connections to a server, and one stream per page would soon leave no connection for
// requests.
import { NotAllowed, fetchJson } from './server';

const kName = 'roadbook_events';
const kRetryMs = 3000;
const kTopics = ['map', 'label', 'classes', 'paint', 'people', 'learning'] as const;

type Topic = (typeof kTopics)[number];
/**
 * Topic `away`: there is no stream; `data` has the reason. Topic `ask`: a page asks for the state.
 * `to`: the only page that shall receive the message.
 */
interface Message {
  topic: Topic | 'away' | 'ask';
  data: string;
  to?: string;
}

export class ServerEvents {
  private readonly channel = new BroadcastChannel(kName);
  private readonly listeners = new Map<string, (data: string) => void>();
  private readonly name = crypto.randomUUID();
  /** The state of the stream, if this page holds it. */
  private state: Message | null = null;

  /**
   * Registers a listener. Topic `map` arrives first, and again after each interruption. No event
   * reports the changes during an interruption.
   */
  on(topic: Topic | 'away', listener: (data: string) => void): void {
    this.listeners.set(topic, listener);
  }

  begin(): void {
    this.channel.addEventListener('message', ({ data }) => this.receive(data as Message));
    this.channel.postMessage({ topic: 'ask', data: this.name } satisfies Message);
    // Keeps the lock until this page ends. Then the next page gets it.
    void navigator.locks.request(kName, () => {
      this.listen();
      return new Promise<void>(() => {});
    });
  }

  private receive(message: Message): void {
    if (message.topic === 'ask') {
      if (this.state) this.channel.postMessage({ ...this.state, to: message.data });
    } else if (!message.to || message.to === this.name) {
      this.listeners.get(message.topic)?.(message.data);
    }
  }

  private broadcast(topic: Message['topic'], data: string): void {
    const message = { topic, data };
    if (topic === 'map' || topic === 'away') this.state = message;
    this.channel.postMessage(message);
    this.receive(message);
  }

  private listen(): void {
    const events = new EventSource('api/events');
    for (const topic of kTopics)
      events.addEventListener(topic, (event) => this.broadcast(topic, (event as MessageEvent<string>).data));
    events.addEventListener('error', () => {
      if (events.readyState === EventSource.CLOSED) void this.retryLater();
      else this.broadcast('away', 'The server does not answer');
    });
  }

  // A browser reconnects after an interruption, but not after a refusal by the server.
  private async retryLater(): Promise<void> {
    try {
      await fetchJson('GET', 'api/progress');
      this.broadcast('away', 'Too many pages are open: close one to use this page');
    } catch (fault) {
      this.broadcast('away', (fault as Error).message);
      if (fault instanceof NotAllowed) return;
    }
    window.setTimeout(() => this.listen(), kRetryMs);
  }
}
