// What the right mouse button offers.
import { canvas } from '../state/canvas.svelte.ts';
import { runs } from '../state/runs.svelte.ts';
import { session } from '../state/session.svelte.ts';
import { ui, type MenuItem, type Point } from '../state/ui.svelte.ts';
import * as act from './actions.ts';
import { addBend, removeBend, setBends } from './bends.ts';

const separator: MenuItem = {label: '-'};

export const alignments: [act.Alignment, string][] = [
  ['left', 'Left sides'], ['right', 'Right sides'], ['top', 'Tops'], ['middle', 'Middles'], ['columns', 'Side by side'], ['rows', 'One below another']];

export function nodeMenu(at: Point, name: string) {
  if (!canvas.selected.includes(name)) canvas.select([name]);
  const node = session.node(name), several = canvas.selected.length > 1, locked = session.readOnly;
  if (!node) return;
  const items: MenuItem[] = [
    {label: 'Look at it', keys: 'L', act: () => look(name)},
    ...(node.level !== undefined ? [{label: 'Step into the subgraph', keys: 'Enter', act: () => void session.enter(name)}] : []),
    {label: 'Run up to here', act: () => void runs.run(false, [{level: session.levelName, node: name}])},
    separator,
    {label: 'Connect to …', keys: 'C', act: () => { ui.connecting = {node: name}; }, disabled: locked || several},
    {label: 'Add behind …', keys: 'Space', act: act.openBehind, disabled: locked || several},
    separator,
    {label: 'Cut', keys: 'Ctrl+X', act: () => void act.copySelected(true), disabled: locked},
    {label: 'Copy as JSON', keys: 'Ctrl+C', act: () => void act.copySelected()},
    {label: 'Duplicate', keys: 'Ctrl+D', act: () => void act.duplicate(), disabled: locked},
    {label: 'Rename …', keys: 'F2', act: () => act.rename(name), disabled: locked || several},
    {label: 'Delete', keys: 'Del', act: () => void act.removeSelected(), disabled: locked},
    separator,
    {label: node.mute ? 'Unmute' : 'Mute', keys: 'M', act: () => act.setOnSelected('mute'), disabled: locked},
    {label: node.pinned ? 'Unpin the picture' : 'Pin the picture', keys: 'P', act: () => act.setOnSelected('pin'), disabled: locked},
    {label: 'Group as a subgraph …', keys: 'Ctrl+G', act: act.group, disabled: locked},
    ...(node.level !== undefined ? [{label: 'Ungroup', keys: 'Ctrl+Shift+G', act: () => void act.ungroup(name), disabled: locked}] : []),
    {label: 'Frame …', keys: 'Shift+F', act: act.frame, disabled: locked},
    {label: 'Align', disabled: locked || !several,
     more: alignments.map(([how, label]) => ({label, act: () => act.align(how)}))},
  ];
  ui.menu = {at, items, label: several ? `${canvas.selected.length} nodes` : name};
}

export function wireMenu(at: Point, id: string) {
  canvas.select([], [id]);
  const place = canvas.pane?.toCanvas(at), bends = canvas.edges.find((e) => e.id === id)?.data?.bends ?? [];
  ui.menu = {at, label: 'wire', items: [
    {label: 'Bend it here', keys: 'B', act: () => place && addBend(id, place), disabled: session.readOnly},
    ...(bends.length ? [{label: 'Without bends', act: () => void setBends(id, [], 'straighten a wire'), disabled: session.readOnly}] : []),
    {label: 'Remove the wire', keys: 'Del', act: () => void act.disconnect(id), disabled: session.readOnly},
    {label: 'Go to its source', act: () => canvas.go(canvas.edges.find((e) => e.id === id)!.source)},
    {label: 'Go to its end', act: () => canvas.go(canvas.edges.find((e) => e.id === id)!.target)},
  ]};
}

export function bendMenu(at: Point, id: string, index: number) {
  canvas.select([], [id]);
  canvas.pickedBend = {wire: id, index};
  ui.menu = {at, label: 'bend', items: [{label: 'Remove the bend', keys: 'Del', act: () => removeBend(id, index), disabled: session.readOnly}]};
}

export function frameMenu(at: Point, id: string) {
  canvas.select(['frame:' + id]);
  ui.menu = {at, label: 'frame', items: [
    {label: 'Title …', keys: 'F2', act: () => act.retitle(id), disabled: session.readOnly},
    {label: 'Remove the frame', keys: 'Del', act: () => void act.removeSelected(), disabled: session.readOnly}]};
}

export function paneMenu(at: Point) {
  const locked = session.readOnly, {document} = session;
  ui.menu = {at, label: 'canvas', items: [
    {label: 'Add a node …', keys: 'Tab', act: () => act.openPalette(at), disabled: locked},
    {label: 'Paste', keys: 'Ctrl+V', act: () => void act.paste(), disabled: locked},
    {label: 'Frame …', keys: 'Shift+F', act: act.frame, disabled: locked},
    separator,
    {label: 'Undo ' + (document?.undo ?? ''), keys: 'Ctrl+Z', act: () => void session.undo(), disabled: locked || document?.undo === undefined},
    {label: 'Redo ' + (document?.redo ?? ''), keys: 'Ctrl+Shift+Z', act: () => void session.redo(), disabled: locked || document?.redo === undefined},
    separator,
    {label: 'Select all', keys: 'Ctrl+A', act: () => canvas.select(session.level.nodes.map((n) => n.name))},
    {label: 'Find a node …', keys: 'Ctrl+F', act: () => { ui.finding = true; }},
    {label: 'Show all', keys: 'F', act: () => canvas.pane?.fit()},
    {label: ui.minimap ? 'Hide the map' : 'Show the map', act: () => { ui.minimap = !ui.minimap; ui.keep(); }},
    ...(session.path.length ? [{label: 'Leave the subgraph', keys: 'U', act: () => session.leave()}] : []),
    separator,
    {label: 'Keys', keys: '?', act: () => { ui.help = true; }},
  ]};
}

export function look(name: string) {
  ui.viewOpen = true;
  ui.keep();
  runs.looked = {level: session.levelName, node: name};
}
