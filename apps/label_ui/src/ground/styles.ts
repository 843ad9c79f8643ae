// The styles of objects on the map. Each line has a dark border, so that it is visible on bright
// and dark ground.
import type Feature from 'ol/Feature';
import type { FeatureLike } from 'ol/Feature';
import { Circle, Fill, Stroke, Style } from 'ol/style';
import { asArray } from 'ol/color';
import type { Store } from '../store';
import type { Hypothesis } from '../types';

const kLeastShown = 0.5;
const cache = new Map<string, Style[]>();

/** Returns whether to draw a hypothesis. Unlikely hypotheses would only hide the ground. */
export function shown(h: Hypothesis, asked: Set<number>): boolean {
  return h.probability >= kLeastShown || asked.has(h.index);
}

function cased(colour: string, width: number, dash?: number[], fill?: string): Style[] {
  return [
    new Style({ stroke: new Stroke({ color: '#000a', width: width + 2, lineDash: dash }) }),
    new Style({
      stroke: new Stroke({ color: colour, width, lineDash: dash }),
      fill: new Fill({ color: fill ?? '#0000' }),
    }),
  ];
}

function tinted(colour: string, alpha: number): string {
  const [r, g, b] = asArray(colour);
  return `rgba(${r},${g},${b},${alpha})`;
}

function made(type: string, colour: string, feature: Feature): Style[] {
  switch (type) {
    case 'label':
      return cased(colour, 2, undefined, tinted(colour, 0.18));
    case 'rejected':
      return cased('#ff5b52', 1.5, [2, 4]);
    case 'marked':
      return [
        new Style({ stroke: new Stroke({ color: '#000c', width: 7 }) }),
        new Style({
          stroke: new Stroke({ color: '#fff', width: 5 }),
          fill: new Fill({ color: tinted(colour, 0.1) }),
        }),
        new Style({
          stroke: new Stroke({ color: colour, width: 2.5, lineDash: feature.get('asked') ? [7, 5] : undefined }),
        }),
      ];
    case 'lane':
      return [new Style({ stroke: new Stroke({ color: '#f0e442aa', width: 2 }) })];
    case 'pose':
      return [new Style({ stroke: new Stroke({ color: '#009e73cc', width: 1.5, lineDash: [3, 3] }) })];
    default:
      return feature.get('probability') >= kLeastShown
        ? cased(colour, 2, [7, 5])
        : cased('#ffffff', 1.2, [2, 4]);
  }
}

export function styleOf(feature: Feature, _resolution: number, store: Store): Style[] {
  let type = feature.get('type') as string;
  const kind = (feature.get('kind') as string | undefined) ?? '';
  if (type === 'label' && kind.startsWith('not_')) type = 'rejected';
  const likely = type === 'hypothesis' && feature.get('probability') >= kLeastShown;
  const { colour } = store.classOf(kind);
  const key = `${type} ${colour} ${likely} ${feature.get('asked') === true}`;
  let style = cache.get(key);
  if (!style) cache.set(key, (style = made(type, colour, feature)));
  return style;
}

export function sketchStyle(feature: FeatureLike): Style[] {
  if (feature.getGeometry()!.getType() === 'Point')
    return [
      new Style({
        image: new Circle({
          radius: 4,
          fill: new Fill({ color: '#fff' }),
          stroke: new Stroke({ color: '#000', width: 1.5 }),
        }),
      }),
    ];
  return cased('#ffffff', 2, [5, 4], '#ffffff22');
}
