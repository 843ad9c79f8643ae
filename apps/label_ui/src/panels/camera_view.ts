// Shows the camera image to which the selected object is anchored, with the outline in the image.
import { fetchJson } from '../sync/server';
import type { Store } from '../store';
import type { View } from '../types';

const kSvg = 'http://www.w3.org/2000/svg';
const kWaitMs = 120;

export class CameraView {
  private timer = 0;
  private requestCount = 0;
  private image: SVGImageElement | null = null;

  constructor(
    private readonly store: Store,
    private readonly picture: HTMLElement,
    private readonly text: HTMLElement,
  ) {
    for (const topic of ['selection', 'labels', 'hypotheses'] as const)
      store.on(topic, () => this.scheduleUpdate());
  }

  // Keys can change a box quickly. The view is updated when no key is pressed for a while.
  private scheduleUpdate(): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.load(), kWaitMs);
  }

  private async load(): Promise<void> {
    const number = ++this.requestCount;
    const hypothesis = this.store.selectedHypothesis();
    const label = this.store.selectedLabel();
    if (!hypothesis && !label) return this.show(null, '#fff', 'Select a label or hypothesis to see its camera image');
    const subject = hypothesis ? { ...hypothesis, shape: 'box', source: 'detected' } : { id: label!.id };
    const kind = hypothesis?.kind ?? label!.kind;
    try {
      const view = await fetchJson<View | null>('POST', 'api/view', { ...subject, map: this.store.start.map });
      if (number !== this.requestCount) return;
      // Images of another map have the same addresses. The parameter prevents the browser from
      // using its cached images.
      if (view?.image) view.image += `?map=${encodeURIComponent(this.store.start.map)}`;
      this.show(view, this.store.classOf(kind).colour, 'No camera image shows this place');
    } catch (fault) {
      if (number === this.requestCount) this.show(null, '#fff', (fault as Error).message);
    }
  }

  private show(view: View | null, colour: string, otherwise: string): void {
    if (!view) {
      this.image = null;
      this.picture.replaceChildren();
      this.text.textContent = otherwise;
      return;
    }
    const svg = element('svg', { viewBox: `0 0 ${view.width} ${view.height}`, role: 'img' });
    svg.setAttribute('aria-label', `${view.camera} with the outline of the selection`);
    const image =
      this.image?.getAttribute('href') === view.image
        ? this.image
        : (element('image', { href: view.image ?? '', width: view.width, height: view.height }) as SVGImageElement);
    this.image = view.image ? image : null;
    if (view.image) svg.append(image);
    const points = view.outline.map(([u, v]) => `${u.toFixed(1)},${v.toFixed(1)}`).join(' ');
    for (const [stroke, width] of [['#000', 9], [colour, 5]] as const)
      svg.append(element('polygon', { points, class: 'box', stroke, 'stroke-width': (width * view.width) / 1280 }));
    this.picture.replaceChildren(svg);
    this.text.textContent = `${view.session}, ${view.camera}${view.image ? '' : ' (image not available: start the server with --drive FOLDER)'}`;
  }
}

function element(name: string, fields: Record<string, string | number>): SVGElement {
  const made = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(fields)) made.setAttribute(key, String(value));
  return made;
}
